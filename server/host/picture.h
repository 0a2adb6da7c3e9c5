#pragma once
/// How exactly a viewer must be told where nodes are so that its picture is the same.
#include <Eigen/Geometry>

#include "cloth/levels/view_cone.h"

namespace weft::host {

/// From corner to corner of the picture that a viewer is taken to draw, pixels: 1920 x 1080.
inline constexpr double kPicturePixels = 2203;
/// No node moves by more than this share of a pixel.
inline constexpr double kPixelShare = 0.25;
/// Quanta that the shorter side of a cell has at least. Rounding then turns a normal, which two neighbours
/// tell, by at most 0.0064 rad (root mean square), and a shade changes by less than the 1 % that an eye can
/// tell.
inline constexpr double kCellQuanta = 32;
/// Lattices that a cloth is sent on at one level, each twice as fine as the one before, from the coarsest
/// that its cells bear; who needs a finer one gets the finest that there is.
inline constexpr int kLattices = 4;

/// What a pixel in the middle of the picture spans, rad. Pictures wider than 2.4 rad are taken for that.
double pixel_angle(double half_angle);

/// Exponent of the largest power of two, m, by which a cloth within `box` may be quantised for the picture
/// that `view` just holds: seen from there no node moves by more than kPixelShare of a pixel as it is in the
/// picture's middle. `cell`: shorter side of a cell of what is sent, m.
int exponent_for_picture(const ViewCone& view, const Eigen::AlignedBox3d& box, double cell);

}  // namespace weft::host
