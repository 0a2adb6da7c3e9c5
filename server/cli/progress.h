#pragma once
#include <chrono>
#include <string>

namespace weft::cli {

/// A progress bar on standard error, if that is a terminal; otherwise nothing.
class Progress {
 public:
  /// `unit` names what is counted.
  Progress(std::string label, int total, std::string unit = "frames");
  /// Leaves the cursor on an empty line.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// A line above the bar; on standard error in any case.
  void print(const std::string& line) const;
  /// Draws at most ten times a second.
  void show(int done);

 private:
  using Clock = std::chrono::steady_clock;
  std::string label_;
  int total_;
  std::string unit_;
  bool terminal_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point drawn_{};
};

}  // namespace weft::cli
