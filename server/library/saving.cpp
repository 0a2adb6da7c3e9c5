#include "cloth/core/archive.h"
#include "cloth/core/fnv1a.h"
#include "cloth/world/description_archive.h"
#include "cloth/world/state.h"
#include "library/world_impl.h"

namespace weft {
namespace {

std::uint64_t hash_of(std::string_view bytes) {
  Fnv1a hash;
  hash.add(bytes.data(), bytes.size());
  return hash.value();
}

/// A saved state: of which scene it is, a checksum of what follows, and that.
struct Seal {
  std::uint64_t scene = 0, content = 0;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(scene, content);
  }
};

}  // namespace

std::string World::save() const {
  std::string content;
  StateWriter write(content);
  write(impl_->effects, impl_->effects_off, impl_->seen_levels, save_state(impl_->simulation));
  std::string state;
  StateWriter seal(state);
  seal(Seal{hash_of(impl_->scene.document), hash_of(content)});
  return state + content;
}

void World::restore(std::string_view state) {
  Seal seal;
  StateReader read(state);
  try {
    read(seal);
  } catch (const BadState& error) {
    throw Error(error.what());
  }
  if (seal.scene != hash_of(impl_->scene.document)) throw Error("the state is of another scene");
  const std::string_view content = state.substr(state.size() - read.rest());
  if (seal.content != hash_of(content)) throw Error("the state was cut off or changed");
  try {
    std::string simulated;
    read(impl_->effects, impl_->effects_off, impl_->seen_levels, simulated);
    load_state(impl_->simulation, simulated);
  } catch (const std::exception& error) {
    impl_->begin_anew();
    throw Error(error.what());
  }
}

}  // namespace weft
