#include "host/frame_encoder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/picture.h"

namespace weft::host {
namespace {

/// Codec 1 at its worst: 19 bits a value and a width byte for 16 of them, three axes.
std::size_t largest_record(const Grid& grid) {
  const std::size_t nodes = static_cast<std::size_t>(grid.nodes());
  return protocol::kHeaderBytes + 3 * ((nodes * 19 + 7) / 8 + nodes / 16 + 2);
}

/// The grid as level `level` sees it: every 2^(simulated - level)th node.
protocol::GridView coarsened(const VectorField<float>& position, const Vec3& place, int simulated_level,
                             int level) {
  const Grid& grid = position.grid();
  const int step = 1 << (simulated_level - level);
  protocol::GridView view;
  view.data = {position.x.row(0), position.y.row(0), position.z.row(0)};
  view.rows = (grid.rows - 1) / step + 1;
  view.cols = (grid.cols - 1) / step + 1;
  view.row_step = static_cast<std::ptrdiff_t>(grid.stride) * step;
  view.col_step = step;
  view.place = {place.x(), place.y(), place.z()};
  return view;
}

}  // namespace

int finest_sendable_level(const BaseCells& base, std::size_t frame_bytes) {
  int level = kMaxLevel;
  while (level > kMinLevel && largest_record(base.at(level)) > frame_bytes) --level;
  return level;
}

void FrameEncoder::capture(const Simulation<float>& simulation, const protocol::FrameStamp& stamp) {
  std::vector<protocol::FrameBall> balls;
  for (const Ball& ball : simulation.colliders().balls()) {
    const Eigen::Vector3f position = ball.position.cast<float>();
    balls.push_back({ball.id,
                     {position.x(), position.y(), position.z()},
                     static_cast<float>(ball.radius),
                     ball.motion == BallDescription::Motion::dynamic});
  }
  balls_ = std::move(balls);
  obstacles_.clear();
  std::uint32_t index = 0;
  for (const Obstacle& obstacle : simulation.colliders().obstacles()) {
    const Eigen::Vector3f p = obstacle.pose.position.cast<float>();
    const Eigen::Quaternionf q = obstacle.pose.orientation.cast<float>();
    if (obstacle.mobile) obstacles_.push_back({index, {p.x(), p.y(), p.z()}, {q.w(), q.x(), q.y(), q.z()}});
    ++index;
  }
  cloths_.resize(simulation.cloths().size());
  for (std::size_t i = 0; i < cloths_.size(); ++i) {
    cloths_[i].level = simulation.cloths()[i].level();
    cloths_[i].place = simulation.cloths()[i].particles().place;
    cloths_[i].position = simulation.cloths()[i].particles().position;
    const ClothDescription& description = simulation.cloths()[i].description();
    const BaseCells& base = description.base_cells;
    cloths_[i].cell = std::min(description.size.x() / base.cols, description.size.y() / base.rows);
    cloths_[i].box.setEmpty();
    cloths_[i].walls.reset();
    if (const Walls* walls = simulation.cloths()[i].walls()) cloths_[i].walls = *walls;
  }
  stamp_ = stamp;
  forget_encodings();
}

void FrameEncoder::set_flags(std::uint16_t flags) {
  if (stamp_.flags == flags) return;
  stamp_.flags = flags;
  forget_encodings();
}

std::shared_ptr<const FrameMessage> FrameEncoder::message(const std::vector<int>& levels,
                                                          const std::optional<ViewCone>& picture,
                                                          protocol::GridCoding coding) {
  std::vector<Encoding> encodings;
  for (std::size_t i = 0; i < cloths_.size(); ++i)
    encodings.push_back(encoding(i, std::min(levels[i], cloths_[i].level), picture, coding));
  auto& message = messages_[encodings];
  if (message) return message;
  auto made = std::make_shared<FrameMessage>();
  made->frame = stamp_.frame;
  made->epoch = stamp_.epoch;
  for (std::size_t i = 0; i < cloths_.size(); ++i) made->records.push_back(cloth_record(i, encodings[i]));
  made->records.insert(made->records.end(), list_records().begin(), list_records().end());
  message = std::move(made);
  return message;
}

FrameEncoder::Encoding FrameEncoder::encoding(std::size_t cloth, int level,
                                              const std::optional<ViewCone>& picture,
                                              protocol::GridCoding coding) {
  if (!picture) return {level, protocol::kMinQuantumExponent, coding};
  ShownCloth& shown = cloths_[cloth];
  if (shown.box.isEmpty()) {
    const auto [low, high] =
        protocol::box_of(coarsened(shown.position, shown.place, shown.level, shown.level));
    shown.box = {Vec3(low[0], low[1], low[2]), Vec3(high[0], high[1], high[2])};
  }
  return {level, exponent_for_picture(*picture, shown.box, std::ldexp(shown.cell, -level)), coding};
}

const Record& FrameEncoder::cloth_record(std::size_t cloth, const Encoding& encoding) {
  const int level = encoding.level;
  ShownCloth& shown = cloths_[cloth];
  Record& record = shown.records[encoding];
  if (record) return record;
  const auto index = static_cast<std::uint32_t>(cloth);
  const protocol::GridView grid = coarsened(shown.position, shown.place, shown.level, level);
  auto bytes = protocol::encode_cloth_record(stamp_, index, level, shown.level, kBits, grid,
                                             encoding.exponent, encoding.coding);
  std::size_t last = 0;  // where the last of the two begins
  const auto torn = shown.walls ? shown.walls->at(level).torn_faces() : std::vector<std::uint32_t>{};
  if (!torn.empty()) {
    last = bytes.size();
    const auto tears =
        protocol::encode_tears_record(stamp_, index, level, shown.level, grid.rows, grid.cols, torn);
    bytes.insert(bytes.end(), tears.begin(), tears.end());
  }
  // Last for every viewer or for none: the records of one message differ between viewers only in their
  // levels.
  if (balls_.empty() && obstacles_.empty() && cloth + 1 == cloths_.size()) protocol::mark_last(bytes, last);
  record = std::make_shared<const std::vector<std::uint8_t>>(std::move(bytes));
  ++encodes_;
  return record;
}

const std::vector<Record>& FrameEncoder::list_records() {
  if (!list_records_.empty()) return list_records_;
  const auto add = [&](std::vector<std::uint8_t> bytes, bool last) {
    if (last) protocol::mark_last(bytes, 0);
    list_records_.push_back(std::make_shared<const std::vector<std::uint8_t>>(std::move(bytes)));
    ++encodes_;
  };
  if (!balls_.empty()) add(protocol::encode_balls_record(stamp_, balls_), obstacles_.empty());
  if (!obstacles_.empty()) add(protocol::encode_obstacles_record(stamp_, obstacles_), true);
  return list_records_;
}

void FrameEncoder::forget_encodings() {
  for (ShownCloth& cloth : cloths_) cloth.records.clear();
  list_records_.clear();
  messages_.clear();
}

}  // namespace weft::host
