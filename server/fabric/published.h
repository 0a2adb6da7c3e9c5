#pragma once
/// What others have measured, for the named fabrics or cloth like them.
#include <span>
#include <string_view>
#include <vector>

namespace weft::fabric {

/// What an instrument tells.
enum class Quantity {
  bending_length_warp,  ///< ASTM D1388's c, m
  bending_length_weft,
  stretch_warp,  ///< KES-FB1, largest load over its elongation, threads not limited, N/m
  stretch_weft,
  shear,  ///< KES-FB1's G, N/m per radian
  drape,  ///< Cusick's coefficient, a share
};

std::string_view name_of(Quantity quantity);
std::string_view unit_of(Quantity quantity);

/// A number, or the range that several measurements leave.
struct Published {
  std::string_view fabric;
  Quantity quantity;
  double low, high;
  /// Of the very cloth that the fabric's numbers are from. What is not is of cloth like it.
  bool same_cloth;
  std::string_view source;
};

std::span<const Published> published();
std::vector<Published> published_of(std::string_view fabric, Quantity quantity);

}  // namespace weft::fabric
