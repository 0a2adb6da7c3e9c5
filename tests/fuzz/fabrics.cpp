#include <cmath>
#include <variant>

#include "fabric/fit.h"
#include "scene/document.h"
#include "targets.h"

namespace weft::fuzz {

// A file of `weft fabric fit` is refused with reasons, or its numbers are all within their ranges.
void fabrics(Input input) {
  const scene::Document document = scene::read_document(text_of(input));
  if (!document.problems.empty() || !document.overflows.empty() || !document.tree.is_object()) return;
  const auto read = fabric::read_numbers(document.tree);
  if (const auto* problems = std::get_if<std::vector<scene::Problem>>(&read)) {
    require(!problems->empty(), "a refusal has a reason");
    return;
  }
  const auto& numbers = std::get<fabric::Numbers>(read);
  require(std::isfinite(numbers.density) && numbers.density > 0, "a cloth has a mass");
  for (const auto& number : {numbers.emt_warp, numbers.emt_weft, numbers.bending_length_warp,
                             numbers.bending_length_weft, numbers.shear_stiffness, numbers.drape})
    require(!number || (std::isfinite(*number) && *number >= 0), "what was measured is a number");
}

}  // namespace weft::fuzz
