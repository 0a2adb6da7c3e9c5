#include "record/log_writer.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>
#include <vector>

namespace weft::record {
namespace {

namespace fs = std::filesystem;
constexpr const char* kBeside = ".new";

[[noreturn]] void fail(const fs::path& file) {
  throw std::system_error(errno, std::generic_category(), file.string());
}

void sync(int descriptor, const fs::path& file) {
  if (::fsync(descriptor) != 0 && errno != EINVAL) fail(file);  // EINVAL: not of a kind that can be
}

}  // namespace

LogWriter::LogWriter(Reports reports, std::size_t kept)
    : reports_(std::move(reports)),
      kept_(kept),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

LogWriter::~LogWriter() {
  thread_.request_stop();
  thread_.join();
  close();
}

void LogWriter::begin(fs::path file) {
  {
    const std::lock_guard lock(mutex_);
    overrun_ = false;
    waiting_.push_back({std::move(file), {}});
  }
  work_.notify_one();
}

void LogWriter::append(std::string bytes) {
  {
    const std::lock_guard lock(mutex_);
    if (overrun_) return;
    if (waiting_bytes_ + bytes.size() > kMostWaiting) {
      overrun_ = true;
      bytes.clear();  // which gives the file up
      for (; !waiting_.empty() && waiting_.back().file.empty(); waiting_.pop_back())
        waiting_bytes_ -= waiting_.back().bytes.size();
    }
    waiting_bytes_ += bytes.size();
    waiting_.push_back({{}, std::move(bytes)});
  }
  work_.notify_one();
}

void LogWriter::run(const std::stop_token& stop) {
  for (;;) {
    Task task;
    {
      std::unique_lock lock(mutex_);
      work_.wait(lock, stop, [this] { return !waiting_.empty(); });
      if (waiting_.empty()) return;
      task = std::move(waiting_.front());
      waiting_.pop_front();
      waiting_bytes_ -= task.bytes.size();
    }
    try {
      carry_out(task);
    } catch (const std::exception& fault) {
      given_up_ = true;
      close();
      std::error_code none;
      if (!beside_.empty()) fs::remove(std::exchange(beside_, {}), none);  // what there is of it takes room
      if (!std::exchange(failing_, true)) reports_.failing(fault.what());
    }
  }
}

void LogWriter::carry_out(const Task& task) {
  if (!task.file.empty()) {
    close();
    file_ = task.file;
    given_up_ = false;
    return;
  }
  if (given_up_) return;
  if (task.bytes.empty()) throw std::runtime_error(file_.string() + ": the disk is too slow");
  if (descriptor_ < 0) {
    open(task.bytes);
    remove_old();
    reports_.begun();
  } else {
    write(descriptor_, task.bytes);
  }
  if (std::exchange(failing_, false)) reports_.working_again();
}

void LogWriter::open(const std::string& first_bytes) {
  fs::create_directories(file_.parent_path().empty() ? "." : file_.parent_path());
  beside_ = file_.string() + kBeside;
  descriptor_ = ::open(beside_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (descriptor_ < 0) fail(beside_);
  write(descriptor_, first_bytes);
  sync(descriptor_, beside_);
  if (::rename(beside_.c_str(), file_.c_str()) != 0) fail(file_);
  beside_.clear();
  // That it has this name lasts, too.
  const fs::path folder = file_.parent_path().empty() ? "." : file_.parent_path();
  const int parent = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (parent < 0) fail(folder);
  ::fsync(parent);
  ::close(parent);
}

void LogWriter::write(int descriptor, const std::string& bytes) {
  for (std::size_t at = 0; at < bytes.size();) {
    const ssize_t written = ::write(descriptor, bytes.data() + at, bytes.size() - at);
    if (written < 0 && errno != EINTR) fail(file_);
    if (written > 0) at += static_cast<std::size_t>(written);
  }
}

void LogWriter::remove_old() const {
  if (kept_ == 0) return;
  std::vector<fs::path> all, beside;
  for (const auto& entry : fs::directory_iterator(file_.parent_path())) {
    if (entry.path().extension() == file_.extension()) all.push_back(entry.path());
    if (entry.path().extension() == kBeside) beside.push_back(entry.path());
  }
  for (const fs::path& file : beside) fs::remove(file);  // of a process that was killed
  std::sort(all.begin(), all.end());                     // their names count
  for (std::size_t i = 0; i + kept_ < all.size(); ++i) fs::remove(all[i]);
}

void LogWriter::close() {
  if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
}

}  // namespace weft::record
