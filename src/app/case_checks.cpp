// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/case_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "amr/octree.hpp"
#include "app/results.hpp"
#include "app/value.hpp"
#include "core/error.hpp"
#include "core/nearest_name.hpp"
#include "lbm/stream_collide.hpp"

namespace drogue::app {

namespace {

constexpr double largest_mach = 0.3;          // compressibility errors grow with its square
constexpr double largest_tau = 2.0;           // beyond it the error terms of the scheme dominate
constexpr double smallest_tau_excess = 1e-7;  // below it tau - 1/2 is lost in single precision
constexpr double delta_margin = 3.0;          // cells around a marker: half the widest delta, and one to move in

constexpr std::array<const char*, 3> axis_names{"x", "y", "z"};

void check_domain(const Case& c) {
  const Box& box = c.domain.box;
  const double root = amr::block_size * c.domain.coarsest;
  for (int axis = 0; axis < 3; ++axis) {
    const double length = box.upper[axis] - box.lower[axis];
    if (length <= 0.0) {
      fail(c, "domain.upper",
           fmt::format("= {} is not beyond domain.lower = {} in {}", write_value(box.upper), write_value(box.lower),
                       axis_names[axis]));
    }
    const double blocks = length / root;
    if (blocks < 0.5 || std::abs(blocks - std::round(blocks)) > 1e-9 * blocks) {
      fail(c, "grid.coarsest",
           fmt::format("= {} does not divide the domain into blocks: its edge in {}, {} m, must be a multiple of {} "
                       "cells, {} m",
                       c.domain.coarsest, axis_names[axis], length, amr::block_size, root));
    }
    const bool lower_wraps = c.fluid.face[2 * axis].type == fluid::Boundary::periodic;
    const bool upper_wraps = c.fluid.face[2 * axis + 1].type == fluid::Boundary::periodic;
    if (lower_wraps != upper_wraps) {
      const int other = 2 * axis + (lower_wraps ? 1 : 0);
      fail(c, fmt::format("domain.{}.type", face_names[other]),
           fmt::format("is not \"periodic\" although domain.{} is; opposite sides are periodic together",
                       face_names[other ^ 1]));
    }
  }
}

void check_size(const Case& c) {
  const Eigen::Array3d blocks = c.domain.box.size().array() / (amr::block_size * c.domain.coarsest);
  if (blocks.prod() <= amr::most_blocks) return;
  fail(c, "grid.coarsest",
       fmt::format("= {} makes {:.3g} blocks of {}^3 cells; expected at most {}", c.domain.coarsest, blocks.prod(),
                   amr::block_size, amr::most_blocks));
}

void check_spacing(const Case& c, const std::string& key, double spacing) {
  if (level_of(c.domain.coarsest, spacing) != amr::none) return;
  const double level = std::max(0.0, std::round(std::log2(c.domain.coarsest / spacing)));
  fail(c, key,
       fmt::format("= {} is not grid.coarsest / 2^n; expected a halving of {}, for example {}", spacing,
                   c.domain.coarsest, std::ldexp(c.domain.coarsest, -static_cast<int>(level))));
}

void check_grid(const Case& c) {
  check_spacing(c, "grid.finest", c.finest);
  for (std::size_t i = 0; i < c.regions.size(); ++i) {
    const Region& region = c.regions[i];
    const std::string key = fmt::format("grid.region.{}", i);
    check_spacing(c, key + ".spacing", region.spacing);
    if (region.spacing < c.finest * (1.0 - 1e-9)) {
      fail(c, key + ".spacing", fmt::format("= {} is below grid.finest = {}", region.spacing, c.finest));
    }
    if (region.box && (region.box->size().array() <= 0.0).any()) {
      fail(c, key + ".box", fmt::format("= {} is empty; expected [lower, upper]", write_value(*region.box)));
    }
    if (region.box && !region.box->overlaps(c.domain.box)) {
      fail(c, key + ".box", fmt::format("= {} lies outside the domain", write_value(*region.box)));
    }
    if (!region.box && std::ranges::find(c.bodies, region.body, &Body::name) == c.bodies.end()) {
      fail(c, key + ".body", fmt::format("= \"{}\" is not the name of a body", region.body));
    }
  }
}

/// Largest speed [m/s] that enters or starts anywhere, or of the centre of a body; sampled, since it may be any
/// formula.
double largest_speed(const Case& c) {
  constexpr int samples = 5;
  double largest = c.fluid.reference_velocity;
  const auto consider = [&](const Formulas& velocity, const Vec3& place, double time) {
    const Vec3 v(velocity[0](place, time), velocity[1](place, time), velocity[2](place, time));
    largest = std::max(largest, v.norm());
  };
  for (int i = 0; i < samples * samples * samples; ++i) {
    const Eigen::Array3d share =
        Eigen::Array3d(i % samples, i / samples % samples, i / samples / samples) / (samples - 1);
    const Vec3 place = c.domain.box.lower.array() + share * c.domain.box.size().array();
    consider(c.fluid.initial_velocity, place, 0.0);
    for (const fluid::Face& face : c.fluid.face) {
      for (int k = 0; k <= samples; ++k) consider(face.velocity, place, c.end * k / samples);
    }
  }
  for (const Body& body : c.bodies) {
    const auto* rigid = std::get_if<RigidBody>(&body.kind);
    for (double time = 0.0; rigid && time <= c.end; time += time_step(c, 0)) {
      const Vec3 centre = rigid->motion.pose(time)(rigid->shape.centre);
      largest = std::max(largest, rigid->motion.twist(time, time_step(c, 0) / 16.0)(centre).norm());
    }
  }
  return largest;
}

/// What enters must be a number at all times; what depends on the place may be singular where no cell is.
void check_velocities(const Case& c) {
  constexpr int samples = 20;
  for (std::size_t f = 0; f < face_names.size(); ++f) {
    for (const Expression& component : c.fluid.face[f].velocity) {
      for (int k = 0; k <= samples && !component.depends_on_place(); ++k) {
        const double time = c.end * k / samples;
        if (std::isfinite(component(Vec3::Zero(), time))) continue;
        fail(c, fmt::format("domain.{}.velocity", face_names[f]),
             fmt::format("has a component \"{}\" that is not finite at t = {} s", component.text(), time));
      }
    }
  }
}

void check_fluid(const Case& c) {
  check_velocities(c);
  const double mach = std::sqrt(3.0) * c.fluid.lattice_velocity;
  if (mach > largest_mach) {
    fail(c, "fluid.lattice_velocity",
         fmt::format("= {} makes the Mach number {:.3g}; expected at most {}, that is {:.3g}", c.fluid.lattice_velocity,
                     mach, largest_mach, largest_mach / std::sqrt(3.0)));
  }
  const double fastest = mach * largest_speed(c) / c.fluid.reference_velocity;
  if (fastest > largest_mach) {
    fail(c, "fluid.reference_velocity",
         fmt::format(
             "= {} is too small: the largest velocity given, {:.4g} m/s, has the Mach number {:.3g}; expected at "
             "most {}",
             c.fluid.reference_velocity, fastest / mach * c.fluid.reference_velocity, fastest, largest_mach));
  }
  for (int level = 0; level <= level_of(c.domain.coarsest, c.finest); ++level) {
    const double tau = relaxation_time(c, level);
    if (tau <= largest_tau && tau - 0.5 >= smallest_tau_excess) continue;
    const bool given = c.origin.contains("fluid.viscosity");
    fail(c, given ? "fluid.viscosity" : "fluid.reynolds",
         fmt::format("{} the relaxation time {:.10g} on level {} (cells of {} m); expected {} to {}; change the "
                     "viscosity, the spacing or fluid.lattice_velocity",
                     given ? fmt::format("= {} makes", c.fluid.viscosity)
                           : fmt::format("makes the viscosity {:.4g} m^2/s and", c.fluid.viscosity),
                     tau, level, std::ldexp(c.domain.coarsest, -level), 0.5 + smallest_tau_excess, largest_tau));
  }
  const double tau = relaxation_time(c, level_of(c.domain.coarsest, c.finest));
  if (c.fluid.eddy_viscosity != fluid::EddyViscosity::none && tau > lbm::largest_tau_with_eddy_viscosity) {
    fail(c, "fluid.eddy_viscosity",
         fmt::format("makes no sense with the relaxation time {:.4g} of the finest level, which resolves the flow; "
                     "expected at most {}",
                     tau, lbm::largest_tau_with_eddy_viscosity));
  }
}

void check_elastic(const Case& c, const std::string& key, const ElasticBody& body) {
  if (c.contact && body.coupling.scheme == fsi::Scheme::peskin) {
    fail(c, key + ".coupling.scheme", "= \"peskin\", in which the fluid alone moves the body, knows no contact");
  }
  if (c.contact && body.structure.integrator == fem::Integrator::implicit_scheme) {
    fail(c, key + ".integrator", "= \"implicit\" knows no contact; expected \"explicit\"");
  }
  const auto [low, high] = body.structure.volume_ratio;
  if (!(low < 1.0 && high > 1.0)) {
    fail(c, key + ".volume_ratio",
         fmt::format("= {} does not enclose 1, the undeformed state", write_value(body.structure.volume_ratio)));
  }
  for (const Probe& probe : body.probes) {
    if (probe.statistic != "strouhal" || c.reference_length > 0.0) continue;
    fail(c, fmt::format("{}.probe.{}.result", key, probe.name),
         "= \"strouhal\" needs fluid.reference_length and fluid.reference_velocity");
  }
}

void check_rigid(const Case& c, const std::string& key, const RigidBody& body) {
  const int axis = body.shape.span_axis;
  const double length = c.domain.box.size()[axis];
  const bool spans = c.domain.periodic[axis] && std::abs(body.shape.span - length) <= 1e-9 * length;
  if (body.shape.span > 0.0 && !spans) {
    fail(c, key + ".shape.ends",
         fmt::format("= \"open\" needs a cylinder as long as the domain, {} m, along a periodic axis, but {} is {} and "
                     "the length {} m; expected \"capped\" otherwise",
                     length, axis_names[axis], c.domain.periodic[axis] ? "periodic" : "not periodic", body.shape.span));
  }
}

/// Names become parts of columns and files.
void check_name(const Case& c, const std::string& key, const std::string& name) {
  const bool plain = !name.empty() && std::ranges::all_of(name, [](unsigned char letter) {
    return std::isalnum(letter) || letter == '_' || letter == '-';
  });
  if (!plain) fail(c, key + ".name", fmt::format("= \"{}\" is no plain name; expected letters, digits, _ and -", name));
}

void check_bodies(const Case& c) {
  for (std::size_t i = 0; i < c.bodies.size(); ++i) {
    const Body& body = c.bodies[i];
    const std::string key = "body." + body.name;
    check_name(c, key, body.name);
    for (std::size_t j = 0; j < i; ++j) {
      if (c.bodies[j].name == body.name) fail(c, key + ".name", "is given to two bodies");
    }
    if (const auto* elastic = std::get_if<ElasticBody>(&body.kind)) check_elastic(c, key, *elastic);
    if (const auto* rigid = std::get_if<RigidBody>(&body.kind)) check_rigid(c, key, *rigid);
  }
}

void check_contact(const Case& c) {
  if (!c.contact) return;
  if (c.structure.at_rest) {
    fail(c, "contact",
         "needs structures that move, but structure.solver asks for equilibrium; expected \"motion\", with damping");
  }
  if (std::ranges::none_of(c.bodies, is_elastic)) fail(c, "contact", "is of elastic bodies, but there are none");
}

void check_profile(const Case& c, const std::string& key, const Profile& profile) {
  check_name(c, key, profile.name);
  for (const auto& [end, place] : {std::pair{".from", profile.from}, {".to", profile.to}}) {
    if (c.domain.box.contains(place)) continue;
    fail(c, key + end, fmt::format("= {} lies outside the domain", write_value(place)));
  }
  const double length = (profile.to - profile.from).norm();
  if (length == 0.0) fail(c, key + ".to", "is where the line begins");
  for (const double distance : profile.reference.x) {
    if (distance >= 0.0 && distance <= length * (1.0 + 1e-9)) continue;
    fail(c, key + ".reference", fmt::format("has a point {} m from the beginning of a line of {} m", distance, length));
  }
}

void check_measure(const Case& c) {
  if (c.measure.energy && c.reference_length == 0.0) {
    fail(c, "measure.energy", "= true needs fluid.reference_length, in whose units the dissipation is told");
  }
  for (std::size_t i = 0; i < c.measure.profiles.size(); ++i) {
    const std::string key = "measure.profile." + c.measure.profiles[i].name;
    check_profile(c, key, c.measure.profiles[i]);
    for (std::size_t j = 0; j < i; ++j) {
      if (c.measure.profiles[j].name == c.measure.profiles[i].name) fail(c, key + ".name", "is given to two profiles");
    }
  }
}

void check_results(const Case& c) {
  const auto [begin, end] = c.results.stable_window;
  if (begin < 0.0 || end <= begin || end > c.end * (1.0 + 1e-9)) {
    fail(c, "results.stable_window",
         fmt::format("= {} does not lie within the run, 0 to {} s (time.end)", write_value(c.results.stable_window),
                     c.end));
  }
  if (c.results.peak_from >= c.end) {
    fail(c, "results.peak_from",
         fmt::format("= {} leaves no time for a peak; expected less than time.end = {} s", c.results.peak_from, c.end));
  }
  std::vector<std::string> bodies;
  for (const Body& body : c.bodies) bodies.push_back(body.name);
  if (!c.bodies.empty() && std::ranges::find(bodies, c.results.body) == bodies.end()) {
    fail(c, "results.body",
         fmt::format("= \"{}\" is not the name of a body{}", c.results.body, did_you_mean(c.results.body, bodies)));
  }
  const std::vector<std::string> names = result_names(c);
  for (const Reference& reference : c.references) {
    if (std::ranges::find(names, reference.name) != names.end()) continue;
    fail(c, "reference." + reference.name,
         fmt::format("is not the name of a result{}", did_you_mean(reference.name, names)));
  }
}

}  // namespace

void fail(const Case& c, const std::string& key, const std::string& message) {
  std::string known = key;
  while (!c.origin.contains(known) && known.find('.') != std::string::npos) known.resize(known.rfind('.'));
  const auto origin = c.origin.find(known);
  throw InputError(fmt::format("{}: {} {}", origin == c.origin.end() ? c.file.string() : origin->second, key, message));
}

void at_key(const Case& c, const std::string& key, const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    fail(c, key, fmt::format("is wrong: {}", error.what()));
  }
}

void check_case(const Case& c) {
  if (c.has_fluid()) {
    check_domain(c);
    check_size(c);
    check_grid(c);
    check_fluid(c);
  } else if (c.bodies.empty()) {
    fail(c, "fluid.solver", "= \"none\" leaves nothing to simulate; expected a [[body]]");
  }
  check_bodies(c);
  check_contact(c);
  check_measure(c);
  check_results(c);
}

void check_body_in_grid(const Case& c, const Body& body, const std::string& part, std::span<const Vec3> places,
                        const amr::Forest& forest) {
  const auto* rigid = std::get_if<RigidBody>(&body.kind);
  const std::string key = fmt::format("body.{}.{}", body.name, rigid ? rigid->key : "mesh");
  for (const Vec3& place : places) {
    if (forest.locate(place)) continue;
    fail(c, key, fmt::format("lies outside the domain: its {} at {} m", part, write_value(place)));
  }
  const int finest = level_of(c.domain.coarsest, c.finest);
  for (const Vec3& place : places) {
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
      const auto found = forest.locate(place + delta_margin * c.finest * sign);
      if (!found) {
        fail(c, key,
             fmt::format("comes within {} cells of a side of the domain: its {} at {} m", delta_margin, part,
                         write_value(place)));
      }
      const int level = forest.block(found->block).level;
      if (level == finest) continue;
      fail(c, key,
           fmt::format("does not lie in cells of grid.finest = {} m with {} cells around it: its {} at {} m meets "
                       "cells of {} m; widen a grid.region{}",
                       c.finest, delta_margin, part, write_value(place), forest.spacing(level),
                       rigid ? "" : ", or take what need not meet the fluid out of it with coupled = false"));
    }
  }
}

}  // namespace drogue::app
