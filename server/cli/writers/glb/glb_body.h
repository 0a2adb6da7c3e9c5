#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "cli/writers/body_mesh.h"
#include "cli/writers/glb/glb_document.h"
#include "cli/writers/spill_file.h"
#include "cloth/world/description.h"

namespace weft::cli {

/// A vector a frame, put aside from the first that differs on: of what stands still nothing is kept.
class GlbWay {
 public:
  /// `path`: of the .glb.
  explicit GlbWay(std::string path) : path_(std::move(path)) {}

  void add(std::span<const float> vector);
  /// All are the first.
  bool constant() const { return !aside_; }
  const std::vector<float>& first() const { return first_; }
  std::uint64_t count() const { return count_; }
  /// Of the buffer; 0 if it is constant.
  std::uint64_t bytes() const { return aside_ ? aside_->size() : 0; }
  void copy_to(OutputFile& file) {
    if (aside_) aside_->copy_to(file);
  }

 private:
  std::string path_;
  std::vector<float> first_;
  std::uint64_t count_ = 0;
  std::unique_ptr<SpillFile> aside_;
};

/// A body of a .glb: a mesh, and a node that goes as the body went.
class GlbBody {
 public:
  explicit GlbBody(const std::string& path) : positions_(path), quaternions_(path) {}

  void write(const Pose& pose);
  /// Of the buffer, so far.
  std::uint64_t bytes() const { return positions_.bytes() + quaternions_.bytes(); }
  /// Adds all; its way begins at `begin` of the buffer. `times`: an accessor of all frames' times.
  void describe(GlbDocument& document, std::uint64_t begin, const BodyMesh& mesh, int times,
                int material) const;
  void copy_to(OutputFile& file);

 private:
  GlbWay positions_, quaternions_;  ///< x, y, z, m; x, y, z, w
};

}  // namespace weft::cli
