#pragma once
#include <string_view>

namespace weft::study {

/// report.html; the study's data takes the place of "/*study*/null".
std::string_view report_page();

}  // namespace weft::study
