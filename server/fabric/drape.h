#pragma once
#include "cloth/sheet/material.h"

namespace weft::fabric {

/// Cusick's drapemeter (Cusick, The Measurement of Fabric Drape, J. Textile Institute 59, 1968; BS 5058, ISO
/// 9073-9): a round specimen of 30 cm lies between two discs of 18 cm, and what hangs over casts a shadow.
struct Drape {
  double coefficient = 0;  ///< of the ring that hangs over, the share that the shadow covers
  int folds = 0;           ///< round the rim
};

/// `cells` along the specimen's diameter, 16 to 256, even. The round is cut out of the square grid along its
/// links; specimen, disc and shadow are measured by the same faces. No contact of the cloth with itself.
/// Throws NoRest.
Drape drape(const Material& material, int cells = 64);

}  // namespace weft::fabric
