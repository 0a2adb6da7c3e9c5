#pragma once

namespace weft::study {

/// Processor time that the calling thread has had, s. Other threads of the process do not count: a study may
/// be made beside a running server.
double thread_time();

}  // namespace weft::study
