// SPDX-License-Identifier: GPL-3.0-or-later
// A uniform force on the whole fluid. A uniform acceleration a shifts all velocities alike: it changes u and leaves
// density and stress as they are, so of ten moments it adds to three, exactly. With S one step of streaming and
// collision the symmetric splitting F(dt/2) S F(dt/2) is of second order in time (Strang 1968; the half shift of the
// velocity that Guo, Zheng & Shi, Phys. Rev. E 65 (2002) 046308 ask for). The two halves between one S and the next are
// applied at once, so the stored velocity is ahead of the fluid's by `lead` = a dt / 2, which differs from level to
// level: it is taken off where the field is read and exchanged where levels meet.
#include "lbm/solver.hpp"

namespace drogue::lbm {

/// Velocity [cells per step] that the force at `time` [s] adds in half a step of the level.
template <class S>
Vec3 BasicSolver<S>::half_kick(int level, double time) const {
  Vec3 kick;
  for (int a = 0; a < 3; ++a) kick[a] = specification_.force[a](Vec3::Zero(), time);
  return 0.5 * levels_[level].dt / (specification_.density * units_.velocity) * kick;
}

template <class S>
void BasicSolver<S>::set_kick(int level, double time) {
  Level& l = levels_[level];
  l.lead = half_kick(level, time);
  l.relaxation.kick = 2.0 * l.lead;
}

#ifdef __F16C__
template Vec3 BasicSolver<HalfStress>::half_kick(int, double) const;
template void BasicSolver<HalfStress>::set_kick(int, double);
#endif
template Vec3 BasicSolver<FloatStress>::half_kick(int, double) const;
template void BasicSolver<FloatStress>::set_kick(int, double);
template Vec3 BasicSolver<DoubleStress>::half_kick(int, double) const;
template void BasicSolver<DoubleStress>::set_kick(int, double);

}  // namespace drogue::lbm
