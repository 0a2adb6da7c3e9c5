#pragma once
#include <optional>

#include "scene/scene.h"
#include "study/quality.h"

namespace weft::host {

/// Chooses how a scene is stepped so that a wish is met, and keeps to a time as the load changes: what a
/// choice takes now is what the study measured, times how much slower than that the latest steps were. Pure:
/// it knows no clock; the caller tells it what each step took.
class QualityKeeper {
 public:
  /// Steps that tell what a choice takes, before it is judged.
  static constexpr int kSettling = 60;
  /// Steps within the time before something more accurate is tried. Doubled each time that proves too slow,
  /// up to kMostPatience, so that two choices are not swapped for ever.
  static constexpr int kPatience = 180;
  static constexpr int kMostPatience = 64 * kPatience;
  /// Something more accurate is tried only if it is expected to leave a fifth of the time.
  static constexpr double kMargin = 0.8;

  /// `choices` have at least one level.
  explicit QualityKeeper(study::Choices choices) : choices_(std::move(choices)) { choose_anew(); }

  /// Chooses anew. A wish that asks for nothing chooses the scene's own integrator.
  void wish(const scene::Quality& wish);
  /// `level` is the finest that viewers want; chooses anew if that changes.
  void want_level(int level);
  /// A step took `milliseconds`, as it was chosen. Chooses something else if the time is not kept, or if
  /// something better would keep it.
  void stepped(double milliseconds);

  const study::Choices& choices() const { return choices_; }
  /// Nothing if the scene's own integrator is used and the study knows nothing of it.
  const std::optional<study::Choice>& choice() const { return choice_; }
  /// The finest level that keeps the time, if that is coarser than the one wanted.
  std::optional<int> level_cap() const;
  /// What a step of the present choice takes: the study's figure until there are steps, then smoothed over
  /// some of them, ms.
  double measured_ms() const { return choice_ ? slowness_ * choice_->milliseconds : 0; }
  /// Whether the wish is met, by what is expected of the error and measured of the time.
  bool met() const;

 private:
  void choose_anew();
  void change_to(const study::Choice& choice);
  /// The best that keeps `max_ms` at the load as it is; the cheapest of all if none does.
  study::Choice best_within(double max_ms) const;
  void keep(double max_ms);

  study::Choices choices_;
  scene::Quality wish_;
  int wanted_level_ = kMaxLevel;
  std::optional<study::Choice> choice_;
  double slowness_ = 1;  ///< what steps take, to what the study measured; smoothed
  int steps_ = 0;        ///< since the choice was made
  int patience_ = kPatience;
  bool improved_ = false;  ///< the last change was to something better
};

}  // namespace weft::host
