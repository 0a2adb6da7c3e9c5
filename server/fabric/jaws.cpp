#include "fabric/jaws.h"

namespace weft::fabric {
namespace {

constexpr int kJawCols = 17, kJawRows = 65;  // nodes: square cells of 3 mm

SpecimenPlan between_jaws(const Material& material, bool limited) {
  SpecimenPlan plan;
  plan.material = material;
  plan.size = {Jaws::kLength, Jaws::kWidth};
  plan.rows = kJawRows;
  plan.cols = kJawCols;
  plan.bends = false;  // it stays flat
  plan.limited = limited;
  plan.held = [](int, int c) { return c == 0 || c == kJawCols - 1; };
  return plan;
}

}  // namespace

Jaws::Jaws(const Material& material, bool limited) : cloth_(between_jaws(material, limited)) {}

void Jaws::set(double apart, double aside) {
  for (int r = 0; r < kJawRows; ++r) {
    for (int c = 0; c < kJawCols; ++c) {  // all in proportion: little is left to do
      const double share = static_cast<double>(c) / (kJawCols - 1);
      cloth_.put(r, c, cloth_.at(r, c) + share * Vec3(apart - apart_, 0, aside - aside_));
    }
  }
  apart_ = apart;
  aside_ = aside;
  cloth_.rest(0.1, 1e-8, 500);
}

Vec3 Jaws::pull() const {
  Vec3 sum = Vec3::Zero();
  const VectorField<double> force = cloth_.pull();
  for (int r = 0; r < kJawRows; ++r)
    sum -= Vec3(force.x.at(r, kJawCols - 1), force.y.at(r, kJawCols - 1), force.z.at(r, kJawCols - 1));
  return sum / kWidth;
}

}  // namespace weft::fabric
