#pragma once
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace weft::record {

/// Writes files of recordings on a thread of its own, so that no scene waits for a disk. A file that cannot
/// be written on is left as it is, up to there; the next one is tried again.
class LogWriter {
 public:
  /// Bytes that may wait for the disk: beyond them the file is given up.
  static constexpr std::size_t kMostWaiting = std::size_t{64} << 20;

  /// Called on the writer's thread.
  struct Reports {
    std::function<void(const std::string& fault)> failing;  ///< now, and not before
    std::function<void()> working_again;
    std::function<void()> begun;  ///< a file is there, with its first bytes
  };
  /// `kept`: files of the folder that are kept, the newest; 0: all.
  LogWriter(Reports reports, std::size_t kept);
  /// Writes what waits.
  ~LogWriter();
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  /// What comes is for this file. It is there once its first bytes are: written beside, synced and renamed.
  void begin(std::filesystem::path file);
  void append(std::string bytes);

 private:
  struct Task {
    std::filesystem::path file;  ///< of begin
    std::string bytes;           ///< of append
  };
  void run(const std::stop_token& stop);
  void carry_out(const Task& task);
  void open(const std::string& first_bytes);
  void write(int descriptor, const std::string& bytes);
  void remove_old() const;
  void close();

  Reports reports_;
  std::size_t kept_;
  std::mutex mutex_;
  std::condition_variable_any work_;
  std::deque<Task> waiting_;       ///< guarded by mutex_
  std::size_t waiting_bytes_ = 0;  ///< guarded by mutex_
  bool overrun_ = false;           ///< guarded by mutex_: too much waits, until the next file begins
  // The thread's own.
  std::filesystem::path file_;    ///< that was begun
  std::filesystem::path beside_;  ///< where its first bytes are written; empty once it is there
  int descriptor_ = -1;           ///< of it, once it is there
  bool given_up_ = false;
  bool failing_ = false;  ///< as was reported
  std::jthread thread_;   // last: it uses all of the above
};

}  // namespace weft::record
