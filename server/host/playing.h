#pragma once
#include <cstdint>
#include <memory>

#include "record/recording.h"

namespace weft::host {

/// A recording that is shown as a scene.
struct Playing {
  std::shared_ptr<const record::Recording> recording;
  std::uint64_t from = 0;  ///< steps since its beginning: it begins there, and begins anew there
  bool loop = false;       ///< it begins anew at its end; else it pauses there
};

}  // namespace weft::host
