#pragma once
/// The state that viewers are shown, and its encodings: one a cloth and level, whoever asks.
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "cloth/world/simulation.h"
#include "host/viewer.h"
#include "protocol/frame.h"

namespace weft::host {

/// The finest level of a cloth whose record stays within `frame_bytes` whatever the positions.
int finest_sendable_level(const BaseCells& base, std::size_t frame_bytes);

/// Holds a copy of the last state it was given. Used by the scene's thread alone.
class FrameEncoder {
 public:
  /// Bits of quantisation of every record.
  static constexpr int kBits = 16;

  /// Takes over what is to be shown: a state that the step guard has let pass.
  void capture(const Simulation<float>& simulation, const protocol::FrameStamp& stamp);
  /// The same state under other flags.
  void set_flags(std::uint16_t flags);
  const protocol::FrameStamp& stamp() const { return stamp_; }

  /// Level at which `cloth` was simulated.
  int simulated_level(std::size_t cloth) const { return cloths_[cloth].level; }
  /// The state with cloth i at levels[i], or at its simulated level if that is coarser.
  std::shared_ptr<const FrameMessage> message(const std::vector<int>& levels);
  /// Records encoded so far.
  std::uint64_t encodes() const { return encodes_; }

 private:
  struct ShownCloth {
    int level = 0;
    Vec3 place{0, 0, 0};            ///< Particles::place
    VectorField<float> position;    ///< from there
    std::optional<Walls> walls;     ///< if it is torn
    std::map<int, Record> records;  ///< by level
  };
  /// With its tears, if it has any.
  const Record& cloth_record(std::size_t cloth, int level);
  /// Balls, then obstacles; no record for none.
  const std::vector<Record>& list_records();
  void forget_encodings();

  protocol::FrameStamp stamp_;
  std::vector<ShownCloth> cloths_;
  std::vector<protocol::FrameBall> balls_;
  std::vector<protocol::FrameObstacle> obstacles_;  ///< those that are not where `scene` says
  std::vector<Record> list_records_;                ///< empty until encoded
  std::map<std::vector<int>, std::shared_ptr<const FrameMessage>> messages_;  ///< by levels
  std::uint64_t encodes_ = 0;
};

}  // namespace weft::host
