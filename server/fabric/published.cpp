#include "fabric/published.h"

#include <algorithm>
#include <array>
#include <iterator>

namespace weft::fabric {
namespace {

// Those of the 618 fabrics whose areal density is within 10 % of the fabric's: from the tenth to the
// ninetieth percentile of (B / (density g))^(1/3).
constexpr std::string_view kFeng =
    "Feng, Huang, Xu, Wang, SIGGRAPH Asia 2022: 10th to 90th percentile of measured fabrics of that weight";
constexpr std::string_view kCodim =
    "table of measured woven fabrics in the source of Codim-IPC (Li, Kaufman, Jiang, SIGGRAPH 2021)";
constexpr std::string_view kPenava =
    "Penava, Simic Penava, Knezic, Fibres and Textiles in Eastern Europe 22(2), 2014, as tabulated in the "
    "source "
    "of Codim-IPC: modulus times thickness";
constexpr std::string_view kWang =
    "Wang, O'Brien, Ramamoorthi, SIGGRAPH 2011: 11 oz denim, 324 g/m2, 1 % spandex, small strain";
constexpr std::string_view kProfile =
    "Analysis of a Fabric Drape Profile, Fibres and Textiles (Liberec) 1/2018, at second hand: cotton plain "
    "weave "
    "of 18.5 to 32 picks/cm";
constexpr std::string_view kTwill =
    "Analysis of a Fabric Drape Profile, Fibres and Textiles (Liberec) 1/2018, at second hand: 3/1 twill of "
    "50/50 "
    "polyester and cotton, 249 g/m2";
constexpr std::string_view kGan =
    "Gan, Ly, Steven, J. Textile Institute 82, 1991, at second hand: a plain woven cotton";

constexpr std::array kPublished{
    Published{"silk", Quantity::bending_length_warp, 0.0140, 0.0299, false, kFeng},
    Published{"silk", Quantity::bending_length_weft, 0.0123, 0.0219, false, kFeng},
    Published{"silk", Quantity::stretch_warp, 774, 774, true, kCodim},
    Published{"silk", Quantity::stretch_weft, 1790, 1790, true, kCodim},
    Published{"silk", Quantity::shear, 51.3, 51.3, true, kCodim},

    Published{"cotton", Quantity::bending_length_warp, 0.0104, 0.0224, false, kFeng},
    Published{"cotton", Quantity::bending_length_weft, 0.0098, 0.0207, false, kFeng},
    Published{"cotton", Quantity::stretch_warp, 2800, 2800, true, kCodim},
    Published{"cotton", Quantity::stretch_weft, 4501, 4501, true, kCodim},
    Published{"cotton", Quantity::stretch_warp, 3955, 10354, false, kPenava},
    Published{"cotton", Quantity::shear, 96.8, 96.8, true, kCodim},
    Published{"cotton", Quantity::drape, 0.4806, 0.7187, false, kProfile},
    Published{"cotton", Quantity::drape, 0.684, 0.684, false, kGan},

    Published{"canvas", Quantity::bending_length_warp, 0.0140, 0.0298, false, kFeng},
    Published{"canvas", Quantity::bending_length_weft, 0.0135, 0.0241, false, kFeng},
    Published{"canvas", Quantity::stretch_warp, 2844, 2844, true, kCodim},
    Published{"canvas", Quantity::stretch_weft, 10496, 10496, true, kCodim},
    Published{"canvas", Quantity::shear, 532.4, 532.4, true, kCodim},

    Published{"denim", Quantity::bending_length_warp, 0.0127, 0.0272, false, kFeng},
    Published{"denim", Quantity::bending_length_weft, 0.0116, 0.0228, false, kFeng},
    Published{"denim", Quantity::stretch_warp, 3163, 3163, true, kCodim},
    Published{"denim", Quantity::stretch_weft, 5959, 5959, true, kCodim},
    Published{"denim", Quantity::shear, 807.8, 807.8, true, kCodim},
    Published{"denim", Quantity::shear, 53.4, 53.4, false, kWang},
    Published{"denim", Quantity::drape, 0.7981, 0.7981, false, kTwill},

    Published{"wool", Quantity::bending_length_warp, 0.0191, 0.0293, false, kFeng},
    Published{"wool", Quantity::bending_length_weft, 0.0177, 0.0221, false, kFeng},
    Published{"wool", Quantity::stretch_warp, 2931, 2931, true, kCodim},
    Published{"wool", Quantity::stretch_weft, 2840, 2840, true, kCodim},
    Published{"wool", Quantity::stretch_warp, 4629, 12416, false, kPenava},
    Published{"wool", Quantity::shear, 237.4, 237.4, true, kCodim},

    Published{"polyester", Quantity::bending_length_warp, 0.0100, 0.0339, false, kFeng},
    Published{"polyester", Quantity::bending_length_weft, 0.0116, 0.0275, false, kFeng},
    Published{"polyester", Quantity::stretch_warp, 1298, 1298, true, kPenava},
    Published{"polyester", Quantity::stretch_weft, 2942, 2942, true, kPenava},

    Published{"stretch_wool", Quantity::bending_length_warp, 0.0100, 0.0324, false, kFeng},
    Published{"stretch_wool", Quantity::bending_length_weft, 0.0116, 0.0276, false, kFeng},
    Published{"stretch_wool", Quantity::stretch_warp, 82, 82, true, kPenava},
    Published{"stretch_wool", Quantity::stretch_weft, 279, 279, true, kPenava},
};

}  // namespace

std::string_view name_of(Quantity quantity) {
  constexpr std::array<std::string_view, 6> kNames{
      "bending_length_warp", "bending_length_weft", "stretch_warp", "stretch_weft", "shear", "drape"};
  return kNames[static_cast<std::size_t>(quantity)];
}

std::string_view unit_of(Quantity quantity) {
  constexpr std::array<std::string_view, 6> kUnits{"m", "m", "N/m", "N/m", "N/m", ""};
  return kUnits[static_cast<std::size_t>(quantity)];
}

std::span<const Published> published() { return kPublished; }

std::vector<Published> published_of(std::string_view fabric, Quantity quantity) {
  std::vector<Published> found;
  std::copy_if(kPublished.begin(), kPublished.end(), std::back_inserter(found),
               [&](const Published& each) { return each.fabric == fabric && each.quantity == quantity; });
  return found;
}

}  // namespace weft::fabric
