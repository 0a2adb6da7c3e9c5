#include "fabric/tensile.h"

#include <algorithm>
#include <vector>

#include "fabric/jaws.h"

namespace weft::fabric {

Tensile tensile(const Material& material, bool limited) {
  Jaws jaws(material, limited);
  // The load between two readings runs straight.
  constexpr double kReading = 2e-3, kLongest = 2;
  Tensile result;
  double strain = 0, load = 0;
  while (load < kLargestLoad) {
    const double next = strain + std::max(kReading, strain * 0.05);
    if (next > kLongest) throw NoRest("the cloth is too soft: 490 N/m stretch it to three times its length");
    jaws.set(next * Jaws::kLength, 0);
    const double reached = jaws.pull().x();
    const double share = reached > kLargestLoad ? (kLargestLoad - load) / (reached - load) : 1;
    const double end = load + share * (reached - load);
    result.work += share * (next - strain) * (load + end) / 2;
    result.extension = strain + share * (next - strain);
    strain = next;
    load = reached;
  }
  result.linearity = result.work / (kLargestLoad * result.extension / 2);
  return result;
}

double stiffness_of(double extension, double shear) { return kLargestLoad / extension - shear; }

}  // namespace weft::fabric
