// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies that touch in a fluid.
#include <gtest/gtest.h>

#include "bodies.hpp"
#include "fem/touching_structures.hpp"

namespace drogue::fsi {
namespace {

using namespace drogue::testing;

/// Two plates in a fluid at rest, which close in on each other at 1 m/s from a distance of 0.06 m.
class ClosingPlates : public fluid::FineStepHook {
 public:
  ClosingPlates(const amr::Forest& forest, bool contact)
      : left_(plate({.density = 20.0, .side = 0.3, .elements = 10}, Vec3(-0.03, 0.0, 0.0))),
        right_(plate({.density = 40.0, .side = 0.25, .elements = 9}, Vec3(0.03, 0.01, 0.0))),
        left_coupling_(left_, forest, coupled("left")),
        right_coupling_(right_, forest, coupled("right")) {
    add_velocity(left_, std::vector<Vec3>(left_.position().size(), Vec3(0.5, 0.0, 0.0)));
    add_velocity(right_, std::vector<Vec3>(right_.position().size(), Vec3(-0.5, 0.0, 0.0)));
    if (contact) touching_.emplace(std::vector{&left_, &right_}, fem::ContactOptions{.gap = 0.02});
  }

  void on_fine_step(fluid::FineStep& step) override {
    if (!touching_) {
      left_coupling_.on_fine_step(step);
      right_coupling_.on_fine_step(step);
      return;
    }
    left_coupling_.meet_fluid(step);
    right_coupling_.meet_fluid(step);
    touching_->advance(step.dt, step.time - step.dt);
    left_coupling_.part_from_fluid(step);
    right_coupling_.part_from_fluid(step);
  }

  Vec3 momentum() const {
    Vec3 sum = Vec3::Zero();
    for (const fem::Structure* body : {&left_, &right_}) {
      for (std::size_t p = 0; p < body->inertia().point.size(); ++p) {
        sum += body->inertia().heavy_mass[p] * body->mean_velocity(static_cast<int>(p));
      }
    }
    return sum;
  }

  /// Between the middles of the plates, from face to face.
  double clearance() const {
    const auto x_of = [](const fem::Structure& body, const Vec3& place) {
      return body.position()[fem::node_nearest(body.mesh(), place)].x();
    };
    return x_of(right_, Vec3(0.025, 0.01, 0.0)) - x_of(left_, Vec3(-0.025, 0.0, 0.0));
  }

 private:
  fem::Structure left_, right_;
  Coupling left_coupling_, right_coupling_;
  std::optional<fem::TouchingStructures> touching_;
};

/// The smallest clearance in 0.16 s.
double closest(bool contact) {
  const amr::Forest forest = cube_of_fine_blocks();
  FakeFluid fluid(forest, fluid_density);
  ClosingPlates plates(forest, contact);
  const Vec3 before = fluid.momentum() + plates.momentum();
  double smallest = INFINITY;
  for (int step = 0; step < 80; ++step) {
    fluid.step(plates, 2e-3);
    smallest = std::min(smallest, plates.clearance());
    EXPECT_LT((fluid.momentum() + plates.momentum() - before).norm(), 1e-6);
  }
  return smallest;
}

class ContactInFluid : public OnOneThread {};

TEST_F(ContactInFluid, bodies_that_meet_stay_apart_and_keep_the_momentum_of_all) {
  EXPECT_GT(closest(true), 0.0);
  EXPECT_LT(closest(false), 0.0);
}

}  // namespace
}  // namespace drogue::fsi
