#include "host/scene_log.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <system_error>
#include <thread>
#include <utility>

#include "host/live_scene.h"
#include "record/last_state.h"

namespace weft::host {
namespace {

namespace fs = std::filesystem;
constexpr const char *kExtension = ".weftrec", *kSetAside = ".aside", *kGone = ".gone";

/// Files of recordings in a folder, the oldest first.
std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    if (entry.path().extension() == kExtension) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// The file, or where there is one already, NAME.2.weftrec and so on: no scene has such a name.
fs::path free_name(const fs::path& file) {
  fs::path free = file;
  for (int number = 2; fs::exists(free); ++number)
    free = file.parent_path() / (file.stem().string() + "." + std::to_string(number) + kExtension);
  return free;
}

/// Where a folder goes that is to be removed: a name that no scene has.
fs::path gone(const fs::path& folder) {
  std::string name(1, '.');
  name += folder.filename().string();
  name += kGone;
  return folder.parent_path() / name;
}

/// Until it is, or for 2 s, as on a disk that is full.
template <class Done>
void wait_for_disk(const Done& done) {
  constexpr std::chrono::milliseconds kLongest(2000), kStep(5);
  const auto until = std::chrono::steady_clock::now() + kLongest;
  while (!done() && std::chrono::steady_clock::now() < until) std::this_thread::sleep_for(kStep);
}

std::uint64_t number_of(const fs::path& file) {
  const std::string stem = file.stem().string();
  std::uint64_t number = 0;
  std::from_chars(stem.data(), stem.data() + stem.size(), number);
  return number;
}

}  // namespace

SceneLog::SceneLog(const scene::Scene& scene, LogPlaces places, SceneMetrics& metrics)
    : scene_(scene),
      places_(std::move(places)),
      metrics_(metrics),
      recorded_steps_(static_cast<std::uint64_t>(
          std::max(1.0, std::round(kRecordedStates / scene.simulation.time_step)))),
      next_recorded_state_(recorded_steps_) {}

void SceneLog::begin(LiveScene& live) {
  const bool restored = !places_.data.empty() && restore(live);
  if (!places_.record.empty()) {
    record_writer_ = writer("recording", 0);
    record_writer_->begin(free_name(places_.record));
    recording_ = recorder(*record_writer_, false);
    // One that goes on from data does not begin at the scene's own beginning.
    if (restored) recording_->add_state(live.simulation());
    live.record({recording_});
    recording_->flush();
  }
  if (!places_.data.empty()) {
    data_writer_ = writer("data", kKept);
    const fs::path file = begin_file(live);
    // Before anybody is shown the scene: else the next start, after a kill, would be in the same epoch.
    std::error_code none;
    wait_for_disk([&] { return fs::exists(file, none); });
  }
}

void SceneLog::tend(LiveScene& live, bool served) {
  changed_ = changed_ || served;
  if (data_) {
    if (served) {
      std::string service = live.save_service();
      if (service != service_) data_->add_service(service_ = std::move(service));
    }
    const bool news = changed_ || live.simulation().step_count() != steps_at_;
    if (news && std::chrono::steady_clock::now() >= state_due_) begin_file(live);
    data_->flush();
  }
  if (!recording_) return;
  if (recording_->steps() >= next_recorded_state_) {
    recording_->add_state(live.simulation());
    next_recorded_state_ += recorded_steps_;
  }
  // Not at each step, so that one entry stands for many.
  if (!served && std::chrono::steady_clock::now() < record_due_) return;
  recording_->flush();
  record_due_ = std::chrono::steady_clock::now() + kRecordPeriod;
}

void SceneLog::end(LiveScene& live) {
  if (recording_) {
    recording_->add_state(live.simulation());
    recording_->flush();
  }
  if (data_ && (changed_ || live.simulation().step_count() != steps_at_)) begin_file(live);
}

void SceneLog::forget() {
  data_.reset();
  data_writer_.reset();
  if (places_.data.empty()) return;
  for (const fs::path& folder : {places_.data, gone(places_.data)}) {
    std::error_code fault;
    fs::remove_all(folder, fault);
    if (fault) spdlog::error("scene {}: {}: {}", scene_.name, folder.string(), fault.message());
  }
}

fs::path SceneLog::begin_file(LiveScene& live) {
  if (data_) data_->flush();
  char name[32];
  std::snprintf(name, sizeof name, "%012llu%s", static_cast<unsigned long long>(next_file_++), kExtension);
  fs::path file = places_.data / name;
  data_writer_->begin(file);
  data_ = recorder(*data_writer_, true);
  data_->add_state(live.simulation());
  data_->add_hash(live.simulation());
  data_->add_service(service_ = live.save_service());
  data_->flush();
  if (recording_) {
    live.record({recording_, data_});
  } else {
    live.record({data_});
  }
  steps_at_ = live.simulation().step_count();
  changed_ = false;
  state_due_ = std::chrono::steady_clock::now() + kStatePeriod;
  return file;
}

std::shared_ptr<record::Recorder> SceneLog::recorder(record::LogWriter& writer, bool of_data) const {
  nlohmann::json more{{"weft", metrics_.version()}};
  if (of_data) more["made"] = places_.made;
  return std::make_shared<record::Recorder>(
      scene_, more, [&writer](std::string bytes) { writer.append(std::move(bytes)); });
}

std::unique_ptr<record::LogWriter> SceneLog::writer(const char* what, std::size_t kept) {
  return std::make_unique<record::LogWriter>(
      record::LogWriter::Reports{
          [name = scene_.name, what, this](const std::string& fault) {
            metrics_.log_failed();
            spdlog::error("scene {}: {}: {}; it runs on without", name, what, fault);
          },
          [name = scene_.name, what] { spdlog::info("scene {}: {} is written again", name, what); },
          [this] { metrics_.saved(); }},
      kept);
}

bool SceneLog::restore(LiveScene& live) {
  std::vector<fs::path> files = files_in(places_.data);
  if (!files.empty()) next_file_ = number_of(files.back()) + 1;
  for (; !files.empty(); files.pop_back()) {
    if (go_on_from(live, files.back())) return true;
    std::error_code fault;
    fs::rename(files.back(), files.back().string() + kSetAside, fault);
    if (fault) spdlog::error("scene {}: {}: {}", scene_.name, files.back().string(), fault.message());
  }
  return false;
}

bool SceneLog::go_on_from(LiveScene& live, const fs::path& file) {
  try {
    const record::Recording recording = record::Recording::of_file(file.string());
    const record::LastState last = record::last_state(recording, metrics_.version(), scene_);
    if (last.service.empty()) throw std::invalid_argument("it tells nothing of the service");
    live.go_on_from(last.state, last.service, std::chrono::steady_clock::now() + kSeatKept);
    spdlog::info("scene {}: goes on at {:.3f} s, epoch {}, from {}{}", scene_.name, live.simulation().time(),
                 live.epoch(), file.string(),
                 recording.damage().empty() ? "" : ", of which " + recording.damage());
    return true;
  } catch (const std::exception& fault) {
    spdlog::error("scene {}: {} is set aside: {}", scene_.name, file.string(), fault.what());
    return false;
  }
}

void wait_until_kept(const fs::path& folder) {
  wait_for_disk([&] { return !files_in(folder).empty(); });
}

void set_gone(const fs::path& folder) {
  std::error_code fault;
  fs::rename(folder, gone(folder), fault);
  if (fault && fault != std::errc::no_such_file_or_directory)
    spdlog::error("{}: {}", folder.string(), fault.message());
}

void remove_gone(const fs::path& data) {
  std::error_code none;
  std::vector<fs::path> all;
  for (const auto& entry : fs::directory_iterator(data, none)) {
    if (entry.path().extension() == kGone) all.push_back(entry.path());
  }
  for (const fs::path& folder : all) fs::remove_all(folder, none);
}

std::vector<KeptScene> made_scenes_in(const fs::path& data) {
  std::vector<KeptScene> scenes;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(data, none)) {
    for (const fs::path& file : files_in(entry.path())) {
      try {
        const record::Recording recording = record::Recording::of_file(file.string());
        if (!recording.head().value("made", false)) continue;
        const KeptScene kept{recording.head().value("name", ""), recording.head().value("document", "")};
        if (kept.name != entry.path().filename()) continue;
        scenes.push_back(kept);
        break;
      } catch (const std::exception&) {  // another file may tell
      }
    }
  }
  std::sort(scenes.begin(), scenes.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return scenes;
}

}  // namespace weft::host
