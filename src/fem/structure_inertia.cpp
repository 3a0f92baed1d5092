// SPDX-License-Identifier: GPL-3.0-or-later
// The masses that a Structure moves with, and what they are to its elements.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "fem/hex_topology.hpp"
#include "fem/structure_data.hpp"

namespace drogue::fem {
namespace {

void check_partition(const Inertia& inertia, std::size_t nodes) {
  if (inertia.mass.size() != inertia.point.size() || inertia.heavy_mass.size() != inertia.point.size()) {
    throw InputError(fmt::format("the inertia has {} points and {} masses, {} of them heavy; expected as many",
                                 inertia.point.size(), inertia.mass.size(), inertia.heavy_mass.size()));
  }
  if (inertia.face_mass.size() != nodes) {
    throw InputError(fmt::format("the inertia has {} masses of faces; expected one of each of {} nodes",
                                 inertia.face_mass.size(), nodes));
  }
  if (!(inertia.reset > -1.0 && inertia.reset <= 1.0)) {
    throw InputError(
        fmt::format("velocities are reset by a factor of {}; expected above -1, at most 1", inertia.reset));
  }
  std::vector<int> uses(nodes, 0);
  for (std::size_t i = 0; i < inertia.point.size(); ++i) {
    const auto [a, b] = inertia.point[i];
    const int last = static_cast<int>(nodes) - 1;
    if (a < 0 || a > last || b < -1 || b > last) {
      throw InputError(fmt::format("point {} joins nodes {} and {}; expected numbers from 0 to {}", i, a, b, last));
    }
    if (!(inertia.mass[i] > 0.0 && std::isfinite(inertia.mass[i]))) {
      throw InputError(
          fmt::format("point {} (node {}) has mass {} kg; expected a positive number", i, a, inertia.mass[i]));
    }
    ++uses[a];
    if (b < 0) continue;
    if (!(inertia.face_mass[a] > 0.0 && inertia.face_mass[b] > 0.0)) {
      throw InputError(
          fmt::format("nodes {} and {} face each other with masses {} and {} kg; expected positive numbers", a, b,
                      inertia.face_mass[a], inertia.face_mass[b]));
    }
    ++uses[b];
  }
  for (std::size_t node = 0; node < nodes; ++node) {
    if (uses[node] != 1) {
      throw InputError(fmt::format("node {} belongs to {} points; expected exactly one", node, uses[node]));
    }
  }
}

}  // namespace

void Structure::set_inertia(Inertia inertia) {
  check_partition(inertia, data_->mesh.nodes.size());
  data_->assign_points(std::move(inertia));
  for (const Point& p : data_->points) {
    if (p.is_pair() || std::ranges::none_of(p.hold, [](const Hold* hold) { return hold && hold->hinged; })) continue;
    throw InputError(
        fmt::format("node {} is held by a hinge, but faces no other node through a solid that is thin against the "
                    "grid; expected a thinner solid, or a hold that is not hinged",
                    p.a));
  }
}

void Structure::Data::assign_points(Inertia new_inertia) {
  const auto& volume = elements.nodal_volume();
  std::vector<Point> new_points;
  for (std::size_t i = 0; i < new_inertia.point.size(); ++i) {
    const auto [a, b] = new_inertia.point[i];
    const double mass = new_inertia.mass[i];
    const Vec3 weight = new_inertia.heavy_mass[i] * loads.gravity;
    if (b < 0) {
      new_points.push_back({a, b, 1.0, 0.0, {mass, own_mass[a], volume[a]}, {}, weight, hold_of_node[a]});
      continue;
    }
    if (hold_of_node[a] != hold_of_node[b]) {
      throw InputError(fmt::format(
          "nodes {} and {} face each other but are not held alike; expected both or neither in a hold", a, b));
    }
    const double face_a = new_inertia.face_mass[a], face_b = new_inertia.face_mass[b];
    const double share_a = face_a / (face_a + face_b), share_b = face_b / (face_a + face_b);
    const double own = own_mass[a] * share_b * share_b + own_mass[b] * share_a * share_a;
    new_points.push_back({a,
                          b,
                          share_a,
                          share_b,
                          {mass, own_mass[a] + own_mass[b], volume[a] + volume[b]},
                          {face_a * face_b / (face_a + face_b), own, volume[a] * volume[b] / (volume[a] + volume[b])},
                          weight,
                          hold_of_node[a]});
  }
  inertia = std::move(new_inertia);
  points = std::move(new_points);
  hold_impulse.assign(points.size(), Vec3::Zero());
  assemble_mass();
  compare_masses();
  contact.reset();
  estimate_largest_frequency();
  if (loads.contact) contact.emplace(*loads.contact, mesh, regions, points, std::pow(largest_frequency, 2));
  reference_step = stable_step();
}

/// The mean of a pair has the mass M and the difference mu, so that their kinetic energy is half of
/// M |s_a v_a + s_b v_b|^2 + mu |v_a - v_b|^2.
void Structure::Data::assemble_mass() {
  mass_matrix = {std::vector<Vec3>(mesh.nodes.size()), {}};
  nodal_weight.assign(mesh.nodes.size(), Vec3::Zero());
  for (const Point& p : points) {
    const double mean = p.mean.mass, difference = p.is_pair() ? p.difference.mass : 0.0;
    mass_matrix.diagonal[p.a].setConstant(mean * p.share_a * p.share_a + difference);
    nodal_weight[p.a] = p.share_a * p.weight;
    if (!p.is_pair()) continue;
    mass_matrix.diagonal[p.b].setConstant(mean * p.share_b * p.share_b + difference);
    mass_matrix.pairs.push_back({p.a, p.b, mean * p.share_a * p.share_b - difference});
    nodal_weight[p.b] = p.share_b * p.weight;
  }
  solver.reset();
  acceleration.clear();
}

// The nodes of a pair are said to have the masses of their difference. A thin hexahedron strains along its thickness by
// differences alone, and along its sides by means and by differences. These count there at most half as much (the mode
// xi zeta has a third of the squared gradient of zeta along xi and a third along zeta), so that a mean lightens the
// sides down to half.
void Structure::Data::compare_masses() {
  std::vector<int> partner(mesh.nodes.size(), -1);
  std::vector<double> ratio(mesh.nodes.size(), 1.0);
  moving_mass.resize(mesh.nodes.size());
  for (const Point& p : points) {
    moving_mass[p.a] = p.mean.mass;
    if (!p.is_pair()) continue;
    moving_mass[p.a] = inertia.face_mass[p.a];
    moving_mass[p.b] = inertia.face_mass[p.b];
    ratio[p.a] = ratio[p.b] = p.mean.mass / (moving_mass[p.a] + moving_mass[p.b]);
    partner[p.a] = p.b;
    partner[p.b] = p.a;
  }
  thin_elements.clear();
  for (const auto& group : elements.groups()) {
    const auto* solid = std::get_if<Solid>(&group->region().kind);
    for (int e = 0; e < group->count(); ++e) {
      const auto nodes = group->nodes_of(e);
      const auto joins_pair = [&](const auto& edge) { return partner[nodes[edge[0]]] == nodes[edge[1]]; };
      const auto thickness = std::find_if(std::begin(hex_edge), std::end(hex_edge), [&](const auto& edges) {
        return solid && std::all_of(std::begin(edges), std::end(edges), joins_pair);
      });
      const bool thin = thickness != std::end(hex_edge);
      double smallest = thin ? 2.0 : 1.0;
      for (const int node : nodes) smallest = std::min(smallest, ratio[node]);
      std::array<double, 3> lightness{1.0 / smallest, 1.0 / smallest, 1.0 / smallest};
      if (thin) {
        const int direction = static_cast<int>(thickness - std::begin(hex_edge));
        lightness[direction] = 1.0;
        auto& added = thin_elements.emplace_back(ThinElement{{}, direction, &solid->material});
        std::ranges::copy(nodes, added.nodes.begin());
      }
      group->set_lightness(e, lightness);
    }
  }
}

}  // namespace drogue::fem
