// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/orthotropic_fabric.hpp"

#include <fmt/format.h>

#include "core/error.hpp"

namespace drogue::fem {

OrthotropicFabric::OrthotropicFabric(double young_warp, double young_weft, double poisson, double shear_modulus)
    : shear(shear_modulus) {
  if (!(young_warp > 0.0 && young_weft > 0.0 && shear_modulus > 0.0)) {
    throw InputError(fmt::format("the moduli of a fabric are {}, {} and {} Pa; expected positive numbers", young_warp,
                                 young_weft, shear_modulus));
  }
  const double remainder = 1.0 - poisson * poisson * young_weft / young_warp;
  if (!(remainder > 0.0)) {
    throw InputError(
        fmt::format("the fabric's Poisson's ratio is {}; expected its square below young_warp / "
                    "young_weft = {:.4g}, or the fabric would give way",
                    poisson, young_warp / young_weft));
  }
  warp = young_warp / remainder;
  weft = young_weft / remainder;
  coupling = poisson * weft;
}

}  // namespace drogue::fem
