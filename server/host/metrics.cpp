#include "host/metrics.h"

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace weft::host {

using prometheus::BuildCounter;
using prometheus::BuildGauge;
using prometheus::BuildHistogram;
using prometheus::Labels;
using prometheus::Registry;

namespace {

prometheus::Counter& counter(Registry& registry, const char* name, const char* help,
                             const Labels& labels = {}) {
  return BuildCounter().Name(name).Help(help).Register(registry).Add(labels);
}

prometheus::Gauge& gauge(Registry& registry, const char* name, const char* help, const Labels& labels = {}) {
  return BuildGauge().Name(name).Help(help).Register(registry).Add(labels);
}

/// From a tenth of a millisecond to the length of a few frames, s.
const prometheus::Histogram::BucketBoundaries& step_seconds() {
  static const prometheus::Histogram::BucketBoundaries seconds{1e-4,  2e-4,  5e-4,  1e-3,  2e-3,  4e-3, 8e-3,
                                                               12e-3, 16e-3, 24e-3, 32e-3, 64e-3, 0.25, 1};
  return seconds;
}

auto& counters(Registry& registry, const char* name, const char* help) {
  return BuildCounter().Name(name).Help(help).Register(registry);
}

auto& guard_events(Registry& registry) {
  return counters(registry, "weft_guard_events_total", "What the step guard did");
}

/// What has been added to a count that may have begun anew.
double growth(std::uint64_t now, std::uint64_t before) {
  return static_cast<double>(now >= before ? now - before : now);
}

}  // namespace

template <class Metric, class... Arguments>
Metric& SceneMetrics::add(prometheus::Family<Metric>& family, const Labels& labels,
                          const Arguments&... arguments) {
  Metric& metric = family.Add(labels, arguments...);
  removals_.emplace_back([&family, &metric] { family.Remove(&metric); });
  return metric;
}

SceneMetrics::SceneMetrics(Registry& registry, const std::string& scene, std::string version)
    : seconds_(add(BuildHistogram().Name("weft_step_seconds").Help("Wall time of a step").Register(registry),
                   {{"scene", scene}}, step_seconds())),
      overruns_(add(counters(registry, "weft_step_overruns_total",
                             "Steps in real time that took longer than the time they stand for"),
                    {{"scene", scene}})),
      energy_lost_(add(counters(registry, "weft_energy_lost_joules_total",
                                "Energy that the numerics took from the cloths' motion"),
                       {{"scene", scene}})),
      energy_given_back_(add(counters(registry, "weft_energy_given_back_joules_total",
                                      "Energy of that which the ledger gave back"),
                             {{"scene", scene}})),
      records_(add(
          counters(registry, "weft_encoded_records_total",
                   "Records encoded: one a cloth, level, lattice and frame, however many viewers there are"),
          {{"scene", scene}})),
      redone_(add(guard_events(registry), {{"scene", scene}, {"event", "redone"}})),
      frozen_(add(guard_events(registry), {{"scene", scene}, {"event", "frozen"}})),
      balls_stopped_(add(guard_events(registry), {{"scene", scene}, {"event", "ball_stopped"}})),
      crowded_(add(guard_events(registry), {{"scene", scene}, {"event", "crowded"}})),
      log_failures_(add(counters(registry, "weft_log_failures_total",
                                 "Times that the scene's data or recording could not be written on"),
                        {{"scene", scene}})),
      rate_(add(BuildGauge()
                    .Name("weft_clock_ratio")
                    .Help("Simulated to real time; 0 while nothing is stepped")
                    .Register(registry),
                {{"scene", scene}})),
      saved_(add(BuildGauge()
                     .Name("weft_state_saved_timestamp_seconds")
                     .Help("When a file with the scene's state was last written; 0: never")
                     .Register(registry),
                 {{"scene", scene}})),
      version_(std::move(version)) {
  auto& viewers = BuildGauge()
                      .Name("weft_scene_viewers")
                      .Help("Viewers by the level of their finest cloth")
                      .Register(registry);
  for (std::size_t level = 0; level < viewers_.size(); ++level)
    viewers_[level] = &add(viewers, {{"scene", scene}, {"level", std::to_string(level)}});
  auto& limited = BuildGauge()
                      .Name("weft_limited_viewers")
                      .Help("Viewers who are kept from frames, by what")
                      .Register(registry);
  limited_by_link_ = &add(limited, {{"scene", scene}, {"by", "link"}});
  limited_by_client_ = &add(limited, {{"scene", scene}, {"by", "client"}});
}

SceneMetrics::~SceneMetrics() {
  for (const auto& remove : removals_) remove();
}

void SceneMetrics::stepped(const Step& step) {
  seconds_.Observe(step.seconds);
  if (step.allowed > 0 && step.seconds > step.allowed) overruns_.Increment();
  // What the numerics bring in is below zero; a counter only grows.
  energy_lost_.Increment(std::max(0.0, step.energy_lost));
  energy_given_back_.Increment(std::max(0.0, step.energy_given_back));
}

void SceneMetrics::guarded(const Guard& guard) {
  redone_.Increment(growth(guard.redone, guard_.redone));
  frozen_.Increment(growth(guard.frozen, guard_.frozen));
  balls_stopped_.Increment(growth(guard.balls_stopped, guard_.balls_stopped));
  crowded_.Increment(growth(guard.crowded, guard_.crowded));
  guard_ = guard;
}

void SceneMetrics::encoded(std::uint64_t records) { records_.Increment(static_cast<double>(records)); }

void SceneMetrics::rate(double rate) { rate_.Set(rate); }

void SceneMetrics::saved() { saved_.SetToCurrentTime(); }

void SceneMetrics::log_failed() { log_failures_.Increment(); }

void SceneMetrics::limited(const Limited& viewers) {
  limited_by_link_->Set(viewers.by_link);
  limited_by_client_->Set(viewers.by_client);
}

void SceneMetrics::viewers(const std::vector<int>& by_level) {
  for (std::size_t level = 0; level < viewers_.size(); ++level)
    viewers_[level]->Set(level < by_level.size() ? by_level[level] : 0);
}

struct Metrics::Own {
  explicit Own(Registry& registry)
      : refused_commands(BuildCounter()
                             .Name("weft_refused_commands_total")
                             .Help("Client messages answered with an error, by its code")
                             .Register(registry)),
        refused_requests(BuildCounter()
                             .Name("weft_refused_requests_total")
                             .Help("HTTP requests answered with an error, by its status")
                             .Register(registry)),
        closed_viewers(BuildCounter()
                           .Name("weft_closed_viewers_total")
                           .Help("Viewers closed for what they did or did not do, by the close code")
                           .Register(registry)),
        frames(counter(registry, "weft_sent_frames_total", "Binary messages sent")),
        frame_bytes(counter(registry, "weft_sent_frame_bytes_total", "Their bytes, without TLS")),
        texts(counter(registry, "weft_sent_texts_total", "Text messages sent")),
        text_bytes(counter(registry, "weft_sent_text_bytes_total", "Their bytes, without TLS")),
        dropped(counter(registry, "weft_dropped_frames_total",
                        "Frames replaced by newer ones before they could be sent")),
        connections(gauge(registry, "weft_connections", "Open connections of any kind")),
        viewers(gauge(registry, "weft_viewers", "Open WebSockets")),
        network(counters(registry, "weft_network_cpu_seconds_total", "Processor time of a network thread")),
        cpu(counter(registry, "process_cpu_seconds_total", "User and system time of the process")),
        memory(gauge(registry, "process_resident_memory_bytes", "Resident memory")),
        descriptors(gauge(registry, "process_open_fds", "Open file descriptors")) {}

  prometheus::Family<prometheus::Counter>&refused_commands, &refused_requests, &closed_viewers;
  prometheus::Counter &frames, &frame_bytes, &texts, &text_bytes, &dropped;
  prometheus::Gauge &connections, &viewers;
  prometheus::Family<prometheus::Counter>& network;
  prometheus::Counter& cpu;
  prometheus::Gauge &memory, &descriptors;
};

Metrics::Metrics(const std::string& version)
    : version_(version),
      registry_(std::make_unique<Registry>(Registry::InsertBehavior::Merge)),
      own_(std::make_unique<Own>(*registry_)) {
  gauge(*registry_, "weft_build_info", "1, with what was built", {{"version", version}}).Set(1);
}

Metrics::~Metrics() = default;

SceneMetrics Metrics::of_scene(const std::string& name) { return {*registry_, name, version_}; }

void Metrics::refused_command(std::string_view code) {
  own_->refused_commands.Add({{"code", std::string(code)}}).Increment();
}
void Metrics::refused_request(unsigned status) {
  own_->refused_requests.Add({{"status", std::to_string(status)}}).Increment();
}
void Metrics::closed_viewer(std::uint16_t code) {
  own_->closed_viewers.Add({{"code", std::to_string(code)}}).Increment();
}
void Metrics::sent_frame(std::size_t bytes) {
  own_->frames.Increment();
  own_->frame_bytes.Increment(static_cast<double>(bytes));
}
void Metrics::sent_text(std::size_t bytes) {
  own_->texts.Increment();
  own_->text_bytes.Increment(static_cast<double>(bytes));
}
void Metrics::dropped_frames(std::uint64_t count) { own_->dropped.Increment(static_cast<double>(count)); }
void Metrics::connections(std::size_t count) { own_->connections.Set(static_cast<double>(count)); }
void Metrics::viewers(std::size_t count) { own_->viewers.Set(static_cast<double>(count)); }

void Metrics::network_thread(std::size_t number, double seconds) {
  const std::lock_guard lock(taken_over_);
  auto& counter = own_->network.Add({{"thread", std::to_string(number)}});
  counter.Increment(std::max(0.0, seconds - counter.Value()));
}

void Metrics::look_at_process() {
  const std::lock_guard lock(taken_over_);
  rusage usage{};
  if (getrusage(RUSAGE_SELF, &usage) == 0) {
    const auto seconds = [](const timeval& time) {
      return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    own_->cpu.Increment(std::max(0.0, seconds(usage.ru_utime) + seconds(usage.ru_stime) - own_->cpu.Value()));
  }
  double pages = 0, resident = 0;
  if (std::ifstream("/proc/self/statm") >> pages >> resident)
    own_->memory.Set(resident * static_cast<double>(sysconf(_SC_PAGESIZE)));
  std::error_code error;
  const std::filesystem::directory_iterator open("/proc/self/fd", error);
  if (!error)
    own_->descriptors.Set(
        static_cast<double>(std::distance(begin(open), std::filesystem::directory_iterator())));
}

std::string Metrics::text() {
  look_at_process();
  return prometheus::TextSerializer().Serialize(registry_->Collect());
}

}  // namespace weft::host
