// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/test_flows.hpp"

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "lbm/solver.hpp"

namespace drogue::bench {

namespace {

using fluid::Collision, fluid::EddyViscosity;

constexpr std::array<Operator, 6> all_operators{{{"bgk", Collision::bgk, EddyViscosity::none},
                                                 {"rr", Collision::rr, EddyViscosity::none},
                                                 {"hrr", Collision::hrr, EddyViscosity::none},
                                                 {"hrr+vreman", Collision::hrr, EddyViscosity::vreman},
                                                 {"hrr+wale", Collision::hrr, EddyViscosity::wale},
                                                 {"hrr+smagorinsky", Collision::hrr, EddyViscosity::smagorinsky}}};

/// In a box of 1 m, viscous enough that no operator diverges however long it is timed.
fluid::Specification shear_flow(const Operator& op, fluid::Storage storage) {
  fluid::Specification s;
  s.density = 1.0;
  s.viscosity = 1e-3;
  s.reference_velocity = 1.0;
  s.collision = op.collision;
  s.eddy_viscosity = op.eddy;
  s.eddy_constant = 0.07;
  s.storage = storage;
  s.initial_velocity = {Expression("sin(2*pi*y)"), Expression(0.1), Expression(0.0)};
  return s;
}

}  // namespace

std::span<const Operator> operators() { return all_operators; }
const Operator& default_operator() { return all_operators[2]; }

std::unique_ptr<fluid::FluidSolver> uniform_flow(int across, const Operator& op, fluid::Storage storage) {
  const amr::Domain domain{{Vec3::Zero(), Vec3::Ones()}, 1.0 / across, {true, true, true}};
  return lbm::make_solver(amr::Forest(domain, 0, amr::any_of({})), shear_flow(op, storage));
}

std::unique_ptr<fluid::FluidSolver> nested_flow(int across, int levels) {
  const amr::Domain domain{{Vec3::Zero(), Vec3::Ones()}, 1.0 / across, {true, true, true}};
  std::vector<amr::RefinementCriterion> cubes;
  for (int level = 1; level < levels; ++level) {
    const double half = std::ldexp(0.5, -level), inside = half * (1.0 - 1e-9);
    const Box cube{Vec3::Constant(0.5 - inside), Vec3::Constant(0.5 + inside)};
    cubes.push_back(amr::refine_box(cube, domain.coarsest, std::ldexp(domain.coarsest, -level)));
  }
  return lbm::make_solver(amr::Forest(domain, levels - 1, amr::any_of(std::move(cubes))),
                          shear_flow(default_operator(), fluid::Storage::half_stress));
}

}  // namespace drogue::bench
