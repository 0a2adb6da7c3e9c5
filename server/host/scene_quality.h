#pragma once
/// What is wished of a scene's quality, what is known of its cost, and what follows for its steps.
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "host/quality_keeper.h"

namespace weft::host {

/// What came of a study.
struct StudyOutcome {
  study::Choices choices;
  std::string why;  ///< there are no choices; else empty
};

/// Belongs to LiveScene; no clock, no lock, no thread. Until somebody wishes for something or asks what it
/// costs, it wants no study and does nothing.
class SceneQuality {
 public:
  /// `own` is the scene's own wish, `integrator` its own integrator.
  SceneQuality(const scene::Quality& own, const IntegratorDescription& integrator);

  /// A viewer's wish; one that asks for nothing is the scene's own again.
  void wish(const scene::Quality& wish);
  /// Somebody wants to know what quality costs.
  void ask() { asked_ = true; }
  /// A study is needed and its outcome is not there.
  const scene::Quality& wished() const { return wish_; }
  /// The simulation goes on from a state in which this was wished, by whatever integrator it had then.
  void go_on_with(const scene::Quality& wished);
  bool wants_study() const { return (asked_ || wish_.asks()) && !studied_; }
  void studied(StudyOutcome outcome);
  /// The scene is another: what was studied is forgotten, and studied anew if a wish needs it; who asked
  /// may ask again. Until then it is stepped by its own integrator.
  void outdated();
  bool has_outcome() const { return studied_; }

  // See QualityKeeper.
  void want_level(int level);
  void stepped(double milliseconds);
  std::optional<int> level_cap() const { return keeper_ ? keeper_->level_cap() : std::nullopt; }

  /// The integrator to be used, if it is another than that of the last call; before the first it is the
  /// scene's own.
  std::optional<IntegratorDescription> take_change();
  /// The scene was reset: its simulation is at its own integrator again.
  void restarted();

  /// `{"max_ms": 2}`, or `{}`.
  nlohmann::json wish_json() const;
  /// `stats`' member `quality`; null while there is neither a wish nor a question.
  nlohmann::json stats_json() const;
  /// The message `curve`, once there is an outcome.
  std::string curve_text() const;

 private:
  const scene::Quality own_;
  const IntegratorDescription own_integrator_;
  const std::string own_label_;
  scene::Quality wish_;
  bool asked_ = false;
  bool studied_ = false;
  int wanted_level_ = kMaxLevel;
  std::string why_;
  std::optional<QualityKeeper> keeper_;  ///< once there are choices
  std::string in_use_;                   ///< name and setting of the integrator last taken
};

}  // namespace weft::host
