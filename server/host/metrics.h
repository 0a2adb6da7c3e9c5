#pragma once
/// What the server counts of itself, in Prometheus' terms. Names, units and meanings:
/// server/docs/operations.md. Every method may be called from any thread, and those that count wait for
/// nobody.
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "cloth/core/grid.h"

namespace prometheus {
class Counter;
template <class>
class Family;
class Gauge;
class Histogram;
class Registry;
}  // namespace prometheus

namespace weft::host {

/// Of one scene.
class SceneMetrics {
 public:
  /// What a step took and did.
  struct Step {
    double seconds = 0;            ///< wall time
    double allowed = 0;            ///< s; 0: it need not keep to real time
    double energy_lost = 0;        ///< J, by the numerics (AdvanceReport)
    double energy_given_back = 0;  ///< J
  };
  /// Events of the step guard since the scene was loaded.
  struct Guard {
    std::uint64_t redone = 0, frozen = 0, balls_stopped = 0, crowded = 0;
  };

  SceneMetrics(prometheus::Registry& registry, const std::string& scene, std::string version);
  /// Takes the scene's metrics away.
  ~SceneMetrics();
  SceneMetrics(const SceneMetrics&) = delete;
  SceneMetrics& operator=(const SceneMetrics&) = delete;

  void stepped(const Step& step);
  void guarded(const Guard& guard);
  void encoded(std::uint64_t records);
  /// The clock's rate, simulated to real time; 0 while nothing is stepped.
  void rate(double rate);
  /// How many viewers see their nearest cloth at each level, from 0.
  void viewers(const std::vector<int>& by_level);
  /// How many viewers are kept from frames by their link, and how many are slow themselves.
  struct Limited {
    int by_link = 0, by_client = 0;
  };
  void limited(const Limited& viewers);
  /// A file with its state is on the disk.
  void saved();
  /// What is written of it could not be.
  void log_failed();
  /// Of Weft.
  const std::string& version() const { return version_; }

 private:
  template <class Metric, class... Arguments>
  Metric& add(prometheus::Family<Metric>& family, const std::map<std::string, std::string>& labels,
              const Arguments&... arguments);

  std::vector<std::function<void()>> removals_;
  prometheus::Histogram& seconds_;
  prometheus::Counter &overruns_, &energy_lost_, &energy_given_back_, &records_;
  prometheus::Counter &redone_, &frozen_, &balls_stopped_, &crowded_;
  prometheus::Counter& log_failures_;
  prometheus::Gauge &rate_, &saved_;
  prometheus::Gauge *limited_by_link_ = nullptr, *limited_by_client_ = nullptr;
  std::array<prometheus::Gauge*, kMaxLevel + 1> viewers_{};
  Guard guard_;  ///< told so far
  std::string version_;
};

/// Of the server.
class Metrics {
 public:
  explicit Metrics(const std::string& version);
  ~Metrics();
  Metrics(const Metrics&) = delete;
  Metrics& operator=(const Metrics&) = delete;

  SceneMetrics of_scene(const std::string& name);

  /// `error` was answered with this code.
  void refused_command(std::string_view code);
  /// A request was answered with an HTTP status of 400 or more.
  void refused_request(unsigned status);
  /// A viewer was closed for what it did or did not do.
  void closed_viewer(std::uint16_t code);
  void sent_frame(std::size_t bytes);
  void sent_text(std::size_t bytes);
  /// Replaced by newer ones before they could be sent.
  void dropped_frames(std::uint64_t count);
  void connections(std::size_t count);
  void viewers(std::size_t count);
  /// Processor time that a network thread has used, s.
  void network_thread(std::size_t number, double seconds);

  /// All of it as Prometheus reads it (text format 0.0.4), with the process' own figures as they are now.
  std::string text();

 private:
  void look_at_process();

  const std::string version_;
  std::unique_ptr<prometheus::Registry> registry_;
  struct Own;
  std::unique_ptr<Own> own_;
  std::mutex taken_over_;  ///< of what others count, told by its growth: that is one thread's at a time
};

}  // namespace weft::host
