#pragma once
/// The state that viewers are shown, and its encodings: one a cloth, level, lattice and coding, whoever asks.
#include <Eigen/Geometry>
#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "cloth/levels/view_cone.h"
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
  /// The state with cloth i at levels[i], or at its simulated level if that is coarser. For a viewer whose
  /// picture that cone just holds, as exact as the picture shows (exponent_for_picture); without one as exact
  /// as can be.
  std::shared_ptr<const FrameMessage> message(const std::vector<int>& levels,
                                              const std::optional<ViewCone>& picture = {},
                                              protocol::GridCoding coding = protocol::GridCoding::plain);
  /// Records encoded so far.
  std::uint64_t encodes() const { return encodes_; }

 private:
  struct Encoding {
    int level = 0;
    int exponent = 0;  ///< of the least quantum
    protocol::GridCoding coding = protocol::GridCoding::plain;
    friend bool operator<(const Encoding& a, const Encoding& b) {
      return std::tie(a.level, a.exponent, a.coding) < std::tie(b.level, b.exponent, b.coding);
    }
  };
  struct ShownCloth {
    int level = 0;
    Vec3 place{0, 0, 0};          ///< Particles::place
    VectorField<float> position;  ///< from there
    std::optional<Walls> walls;   ///< if it is torn
    double cell = 0;              ///< shorter side of a cell of level 0, m
    Eigen::AlignedBox3d box;      ///< holds it; empty until asked for
    std::map<Encoding, Record> records;
  };
  /// How `cloth` is sent at `level` to a viewer with that picture.
  Encoding encoding(std::size_t cloth, int level, const std::optional<ViewCone>& picture,
                    protocol::GridCoding coding);
  /// With its tears, if it has any.
  const Record& cloth_record(std::size_t cloth, const Encoding& encoding);
  /// Balls, then obstacles; no record for none.
  const std::vector<Record>& list_records();
  void forget_encodings();

  protocol::FrameStamp stamp_;
  std::vector<ShownCloth> cloths_;
  std::vector<protocol::FrameBall> balls_;
  std::vector<protocol::FrameObstacle> obstacles_;  ///< those that are not where `scene` says
  std::vector<Record> list_records_;                ///< empty until encoded
  std::map<std::vector<Encoding>, std::shared_ptr<const FrameMessage>> messages_;  ///< by cloth
  std::uint64_t encodes_ = 0;
};

}  // namespace weft::host
