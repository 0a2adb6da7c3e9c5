#pragma once
#include <string_view>

namespace weft::study {

/// report.html; the study's data takes the place of "/*study*/null".
extern const std::string_view kReportPage;

}  // namespace weft::study
