#pragma once
#include "cloth/sheet/material.h"

namespace weft::fabric {

/// The cantilever test of ASTM D1388 (Peirce, The "handle" of cloth as a measurable quantity, J. Textile
/// Institute 21, 1930): a strip of 25 mm is pushed over an edge until the line from there to its tip falls by
/// 41.5 degrees.
struct Cantilever {
  double overhang = 0;                                    ///< m
  double bending_length() const { return overhang / 2; }  ///< c, m
};

/// Along u. A strip without rigidity has no overhang. Throws NoRest.
Cantilever cantilever(const Material& material);

/// Flexural rigidity as the standard has it, G = density g c^3, N m.
double rigidity_of(double bending_length, double density);

}  // namespace weft::fabric
