#pragma once
/// A scene being shown: its simulation, its viewers and what they command. One thread uses it
/// (SceneRunner's); no clock and no lock in here.
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "cloth/world/simulation.h"
#include "host/composition.h"
#include "host/event_queue.h"
#include "host/frame_encoder.h"
#include "host/guard_log.h"
#include "host/put_bodies.h"
#include "host/recorded_simulation.h"
#include "host/scene_quality.h"
#include "host/scene_request.h"
#include "host/seat.h"
#include "host/sight.h"
#include "protocol/message.h"
#include "scene/scene.h"

namespace weft::host {

class LiveScene {
 public:
  /// A dynamic ball farther than this along an axis from the origin and all that the scene begins with has
  /// left and is removed, a dynamic obstacle stays where it is, m.
  static constexpr double kBallRange = 1000.0;
  /// Of a cloth, the scene's own and those that viewers set.
  static constexpr std::size_t kMaxPins = 256;
  /// Steps that may be asked for at once and wait.
  static constexpr int kMaxWaitingSteps = 600;

  /// `playing`: a recording of the scene that is shown in place of a simulation of its own. It can be
  /// watched, paused, stepped and begun anew; what would change it is refused.
  LiveScene(scene::Scene scene, const protocol::Limits& limits, const std::optional<Playing>& playing = {});

  /// A viewer came, as `visit` (Viewer::enter): it is sent `scene`, and a frame at the next publish().
  void add_viewer(std::shared_ptr<Viewer> viewer, std::uint64_t visit);
  void remove_viewer(const Viewer* viewer, std::uint64_t visit);
  using TimePoint = std::chrono::steady_clock::time_point;
  /// The same of one whose connection broke: its hands hold on until then, for whoever comes back with its
  /// seat.
  void lose_viewer(const Viewer* viewer, std::uint64_t visit, TimePoint until);
  /// Hands let go of which nobody came back in time.
  void release_lost(TimePoint now);
  /// Carries out one of its commands and answers it; the code of the error that was the answer, if one was.
  /// The scene is between two steps.
  std::optional<std::string> apply(const std::shared_ptr<Viewer>& viewer, std::uint64_t visit,
                                   const SceneRequest& request);

  /// False while nobody looks, and while paused but for the steps asked for.
  bool wants_step() const;
  /// One step, at the finest level that any viewer needs.
  void step();
  /// Somebody wishes for a quality or asks for the cost, which have to be studied first.
  bool wants_study() const { return quality_.wants_study() && !seats_.empty() && !plays(); }
  /// What is to be studied: the scene, with the effects that are on, and materials and friction as they are.
  SimulationDescription studied() const;
  /// Changes when what is to be studied does: a study of something else is of no use.
  std::uint64_t study_number() const { return study_number_; }
  /// What a study found.
  void take_study(StudyOutcome outcome);
  /// Whether the clock runs behind; viewers are told when it changes.
  void set_slow(bool slow);
  /// Tells viewers what has changed since the last call, of one thing once (EventQueue).
  void tell_events();
  /// Sends each viewer that needs one the newest frame at its levels. `server_ms` is the server's clock.
  void publish(std::uint32_t server_ms);
  /// publish() sends a frame to all.
  bool frame_due() const { return frame_due_; }
  /// There is something to be told or shown.
  bool has_news() const;
  /// Sends each viewer its `stats`; `rate` is of simulated to real time, 0 while nothing is stepped.
  void send_stats(double rate);

  const Simulation<float>& simulation() const { return simulation_; }
  const FrameEncoder& encoder() const { return encoder_; }
  std::uint32_t epoch() const { return epoch_; }
  bool paused() const { return paused_; }
  bool slow() const { return slow_; }
  /// What the log is to tell that has happened since the last call.
  std::vector<std::string> take_warnings() { return std::exchange(warnings_, {}); }
  SceneMetrics::Guard guard_counts() const { return guard_.counts(); }
  /// How many viewers have their finest cloth at each level, from 0.
  std::vector<int> viewers_by_level() const;
  SceneMetrics::Limited limited_viewers() const;
  bool empty() const { return seats_.empty(); }

  /// All that is not its simulation's and lasts when its viewers have gone, written down.
  std::string save_service() const;
  /// Goes on from a state and a service that were saved of the same scene: in a new epoch, as what viewers
  /// saw last may be later. Before any viewer; those who held something are waited for until then. Throws as
  /// load_state.
  void go_on_from(std::string_view state, std::string_view service, TimePoint until);
  /// What is done to the simulation from now on is told to these.
  void record(std::vector<std::shared_ptr<record::Recorder>> recorders) {
    recorded_.record(std::move(recorders));
  }

 private:
  /// The reply's members, or what is wrong with the command.
  using Outcome = std::variant<nlohmann::json, protocol::Error>;

  // What each command does.
  Outcome carry_out(const protocol::SeatResume& resume, Seat& seat);
  Outcome carry_out(const protocol::Camera& camera, Seat& seat);
  Outcome carry_out(const protocol::BallAdd& add, Seat& seat);
  Outcome carry_out(const protocol::BallMove& move, Seat& seat);
  Outcome carry_out(const protocol::BallThrow& thrown, Seat& seat);
  Outcome carry_out(const protocol::BallRemove& remove, Seat& seat);
  Outcome carry_out(const protocol::ObstacleMove& move, Seat& seat);
  Outcome carry_out(const protocol::ObstacleThrow& thrown, Seat& seat);
  Outcome carry_out(const protocol::ObstacleGrab& grab, Seat& seat);
  Outcome carry_out(const protocol::ClothGrab& grab, Seat& seat);
  Outcome carry_out(const protocol::GrabMove& move, Seat& seat);
  Outcome carry_out(const protocol::GrabRelease& release, Seat& seat);
  Outcome carry_out(const protocol::ClothPin& pin, Seat& seat);
  Outcome carry_out(const protocol::ClothUnpin& unpin, Seat& seat);
  Outcome carry_out(const protocol::ClothTune& tuning, Seat& seat);
  Outcome carry_out(const protocol::FrictionSet& set, Seat& seat);
  Outcome carry_out(const protocol::EffectSet& effect, Seat& seat);
  Outcome carry_out(const protocol::EffectTune& tuning, Seat& seat);
  Outcome carry_out(const protocol::WindSet& wind, Seat& seat);
  Outcome carry_out(const protocol::WindZoneSet& set, Seat& seat);
  Outcome carry_out(const protocol::Quality& quality, Seat& seat);
  Outcome carry_out(const protocol::Cost& cost, Seat& seat);
  Outcome carry_out(const protocol::Pause& pause, Seat& seat);
  Outcome carry_out(const protocol::Resume& resume, Seat& seat);
  Outcome carry_out(const protocol::Reset& reset, Seat& seat);
  Outcome carry_out(const protocol::Step& step, Seat& seat);

  bool plays() const { return recorded_.replay() != nullptr; }
  /// Why a recording that is played does not take the command; nothing if it does.
  std::optional<protocol::Error> fixed_by_recording(const SceneCommand& command) const;
  void simulate_step();
  void play_step();
  /// Viewers are told what the recording's commands have changed.
  void follow_played();
  /// All that viewers are told by events, to be compared.
  nlohmann::json told() const;
  /// What follows when the simulation is at its beginning again: in a new epoch.
  void begun_anew();
  /// A ball larger than the scene's largest cloth is none to play with, but swallows it.
  std::optional<protocol::Error> too_large(double radius) const;
  /// What the viewer put before was taken away not long ago.
  std::optional<protocol::Error> may_not_put(const Seat& seat) const;
  /// What made a step take too much work.
  void take_away(const PutBody& body);
  std::optional<protocol::Error> missing_cloth(std::uint32_t cloth) const;
  /// The scene is held at so many points as it may be.
  std::optional<protocol::Error> too_many_grabs() const;
  /// What it is sent: what its distance asks for, or coarser, as its link carries it.
  std::vector<int> sent_levels(const Seat& seat) const;
  void request_levels();
  void use_chosen_integrator();
  std::optional<protocol::Error> missing_effect(const std::string& effect) const;
  /// Does what is due.
  void recompose(Recompose what);
  /// What was studied is of another scene.
  void study_outdated();
  /// All that commands may change of what is studied, to be compared.
  nlohmann::json studied_json() const;
  /// Hands that nobody is known to hold with let go: what was written last is a command without its viewer.
  void release_unheld();
  void set_paused(bool paused);
  void tell_guard_events();
  /// False if there is none. One of the scene's own is studied with the scene's friction from then on.
  bool remove_ball(BallId id);
  void find_range();
  void remove_lost_balls();
  void state_changed();
  void balls_changed(const char* kind, std::uint64_t frame, BallId id);
  void pins_changed(const char* kind, std::size_t cloth);
  void wind_changed();
  void effect_set(const std::string& effect);
  void effect_tuned(const std::string& effect);
  void cloth_tuned(std::size_t cloth);
  void frictions_changed();
  void tell_all(std::string text, std::string_view key = {});
  void tell_curve();          ///< to those who asked, once it is known
  bool frame_wanted() const;  ///< by all, or by one
  std::uint16_t flags() const;

  scene::Scene scene_;
  protocol::Limits limits_;
  RecordedSimulation recorded_;
  const Simulation<float>& simulation_ = recorded_.simulation();
  FrameEncoder encoder_;
  SceneQuality quality_;
  GuardLog guard_;
  std::vector<std::string> warnings_;
  EventQueue events_;
  nlohmann::json told_;             ///< told(), of a recording that is played
  bool divergence_warned_ = false;  ///< the recording does not lead to the states that it tells
  std::vector<Seat> seats_;
  struct LostSeat : HeldSeat {
    TimePoint until;
  };
  std::vector<LostSeat> lost_;
  Sight sight_;
  PutBodies put_bodies_;
  Composition composition_;
  std::uint64_t study_number_ = 0;
  Eigen::AlignedBox3d range_;  ///< of dynamic balls and obstacles (kBallRange)
  int frame_stride_ = 1;       ///< steps from one frame to the next
  std::uint32_t epoch_ = 1;
  std::uint64_t seats_made_ = 0;
  std::uint64_t takes_effect_ = 0;  ///< step at which the command in hand does
  int waiting_steps_ = 0;           ///< asked for by `step`, not made yet
  bool paused_ = false;
  bool slow_ = false;
  bool state_newer_ = true;  ///< than the encoder's copy
  bool frame_due_ = true;    ///< to all viewers
};

}  // namespace weft::host
