#include "cli/progress.h"

#include <unistd.h>

#include <cstdio>
#include <utility>

namespace weft::cli {
namespace {

constexpr const char* kClearLine = "\r\x1b[K";

}  // namespace

Progress::Progress(std::string label, int total, std::string unit)
    : label_(std::move(label)),
      total_(total),
      unit_(std::move(unit)),
      terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (terminal_) std::fputs(kClearLine, stderr);
}

void Progress::print(const std::string& line) const {
  std::fprintf(stderr, "%s%s\n", terminal_ ? kClearLine : "", line.c_str());
}

void Progress::show(int done) {
  const auto now = Clock::now();
  if (!terminal_ || total_ <= 0 || done <= 0 || now - drawn_ < std::chrono::milliseconds(100)) return;
  drawn_ = now;
  constexpr int kWidth = 30;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const int filled = static_cast<int>(static_cast<long long>(kWidth) * done / total_);
  std::string bar(static_cast<std::size_t>(filled), '#');
  bar.resize(kWidth, '.');
  std::fprintf(stderr, "%s%s [%s] %d/%d %s, %.0f s left", kClearLine, label_.c_str(), bar.c_str(), done,
               total_, unit_.c_str(), elapsed * (total_ - done) / done);
  std::fflush(stderr);
}

}  // namespace weft::cli
