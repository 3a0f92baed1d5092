// SPDX-License-Identifier: GPL-3.0-or-later
// Isotropic moduli from Young's modulus and Poisson's ratio, with the checks that every law shares.
#pragma once

namespace drogue::fem {

/// E / (2 (1 + nu)) [Pa]; throws InputError unless `young` [Pa] is positive and `poisson` lies in (-1, 1/2).
double shear_modulus(double young, double poisson);

/// 2 G (1 + nu) / (3 (1 - 2 nu)) [Pa] for `shear` [Pa]; throws InputError unless `poisson` lies in (-1, 1/2).
double bulk_modulus(double shear, double poisson);

}  // namespace drogue::fem
