// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/elements.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/error.hpp"

namespace drogue::fem {
namespace {

std::string described(const std::string& region) {
  return region.empty() ? "the mesh" : fmt::format("region \"{}\"", region);
}

}  // namespace

Elements::Elements(const Mesh& mesh, const std::vector<Region>& regions, const std::vector<Pressure>& pressures,
                   const std::array<double, 2>& volume_ratio) {
  if (mesh.nodes.empty()) throw InputError("the mesh is empty; expected at least one element");
  for (const Region& region : regions) add_region(mesh, region, volume_ratio);
  expect_one_region_each();
  for (const Pressure& pressure : pressures) {
    faces_.push_back({pressure.pressure, make_pressure(mesh, elements_named(mesh, pressure.elements))});
    if (!faces_.back().groups.empty()) continue;
    throw InputError(
        fmt::format("{} has no quadrilaterals or triangles for a pressure to act on", described(pressure.elements)));
  }
  lump(mesh.nodes.size());
  connect_nodes(mesh);
}

void Elements::add_region(const Mesh& mesh, const Region& region, const std::array<double, 2>& volume_ratio) {
  if (!(std::isfinite(region.density) && (region.density > 0.0 || (region.density == 0.0 && region.coupled)))) {
    throw InputError(
        fmt::format("the density of {} is {} kg/m^3; expected a positive number, or 0 of what is coupled with a fluid",
                    described(region.elements), region.density));
  }
  const ElementSet set = elements_of(mesh, region);
  const GroupDescription description{region, volume_ratio};
  const std::size_t before = groups_.size();
  const auto add = [&](std::unique_ptr<ElementGroup> group) {
    if (group) groups_.push_back(std::move(group));
  };
  const char* families = "hexahedra";
  if (const auto* solid = std::get_if<Solid>(&region.kind)) {
    add(make_hexahedra(*solid, description, mesh, set.hexahedra));
  } else if (const auto* membrane = std::get_if<Membrane>(&region.kind)) {
    families = "quadrilaterals or triangles";
    add(make_quadrilaterals(*membrane, description, mesh, set.quadrilaterals));
    add(make_triangles(*membrane, description, mesh, set.triangles));
  } else if (const auto* cable = std::get_if<Cable>(&region.kind)) {
    families = "lines";
    add(make_cables(*cable, description, mesh, set.lines));
  }
  if (groups_.size() == before) {
    throw InputError(fmt::format("{} has no {}; expected at least one", described(region.elements), families));
  }
}

void Elements::expect_one_region_each() const {
  std::map<std::string, int> seen;
  for (const auto& group : groups_) {
    for (int e = 0; e < group->count(); ++e) {
      if (++seen[group->name_of(e)] == 1) continue;
      throw InputError(fmt::format("{} belongs to two regions; expected one", group->name_of(e)));
    }
  }
}

void Elements::lump(std::size_t nodes) {
  nodal_volume_.assign(nodes, 0.0);
  coupled_volume_.assign(nodes, 0.0);
  nodal_mass_.assign(nodes, 0.0);
  for (const auto& group : groups_) {
    std::vector<double> volume(nodes, 0.0);
    group->add_volumes(volume);
    for (std::size_t node = 0; node < nodes; ++node) {
      nodal_volume_[node] += volume[node];
      if (group->region().coupled) coupled_volume_[node] += volume[node];
      nodal_mass_[node] += group->region().density * volume[node];
    }
  }
}

std::vector<const ForceGroup*> Elements::force_groups() const {
  std::vector<const ForceGroup*> all;
  for (const auto& group : groups_) all.push_back(group.get());
  for (const Faces& faces : faces_) {
    for (const auto& group : faces.groups) all.push_back(group.get());
  }
  return all;
}

int Elements::count() const {
  int sum = 0;
  for (const auto& group : groups_) sum += group->count();
  return sum;
}

int Elements::threads() const {
  constexpr int fewest_elements = 256;
  return std::clamp(count() / fewest_elements, 1, omp_get_max_threads());
}

void Elements::connect_nodes(const Mesh& mesh) {
  first_slot_.assign(mesh.nodes.size() + 1, 0);
  for (const ForceGroup* group : force_groups()) {
    for (int e = 0; e < group->count(); ++e) {
      for (const int node : group->nodes_of(e)) ++first_slot_[node + 1];
    }
  }
  for (std::size_t node = 0; node < mesh.nodes.size(); ++node) {
    if (nodal_volume_[node] == 0.0) {
      const Vec3& p = mesh.nodes[node];
      throw InputError(
          fmt::format("node {} at ({:g}, {:g}, {:g}) m is unconnected; expected every node to belong to an element",
                      node, p.x(), p.y(), p.z()));
    }
    first_slot_[node + 1] += first_slot_[node];
  }
  slot_.resize(first_slot_.back());
  stiffness_.resize(slot_.size());
  std::vector<int> next(first_slot_.begin(), first_slot_.end() - 1);
  const auto connect = [&](const ForceGroup& group, const auto& stiffness_of) {
    for (int e = 0; e < group.count(); ++e) {
      const auto nodes = group.nodes_of(e);
      for (int a = 0; a < group.nodes_per_element(); ++a) {
        const int slot = next[nodes[a]]++;
        slot_[slot] = group.force_on(e, a);
        stiffness_[slot] = stiffness_of(e);
      }
    }
  };
  for (const auto& group : groups_) connect(*group, [&](int e) { return group->nodal_stiffness(e); });
  first_load_ = next;
  for (const Faces& faces : faces_) {
    for (const auto& group : faces.groups) connect(*group, [](int) { return nullptr; });
  }
}

bool Elements::vary() const {
  return std::ranges::any_of(faces_, [](const Faces& faces) { return faces.pressure.depends_on_time(); }) ||
         std::ranges::any_of(groups_, [](const auto& g) { return g->region().active.tension.depends_on_time(); });
}

void Elements::set_time(double time, double share) {
  for (const auto& group : groups_) group->set_time(time, share);
  for (Faces& faces : faces_) {
    for (const auto& group : faces.groups) group->set_pressure(share * faces.pressure(Vec3::Zero(), time));
  }
}

void Elements::compute_forces(std::span<const Vec3> x) {
  bool inside = true;
  const auto compute = [&](ForceGroup& group) {
    const int batches = group.batches();
#pragma omp for schedule(static) nowait
    for (int batch = 0; batch < batches; ++batch) inside &= group.compute_forces(batch, x);
  };
  for (const auto& group : groups_) compute(*group);
  for (const Faces& faces : faces_) {
    for (const auto& group : faces.groups) compute(*group);
  }
  if (!inside) out_of_bounds_.store(true, std::memory_order_relaxed);
#pragma omp barrier
}

Elements::Extreme Elements::worst() const {
  Extreme worst{groups_.front().get(), 0, 1.0};
  double excess = 1.0;
  for (const auto& group : groups_) {
    const ElementGroup::Extreme candidate = group->worst();
    if (candidate.excess <= excess) continue;
    excess = candidate.excess;
    worst = {group.get(), candidate.element, candidate.volume_ratio};
  }
  return worst;
}

double Elements::largest_squared_frequency(std::span<const Vec3> x, std::span<const double> mass) {
  const std::vector<double> stiffness = nodal_stiffness(x);
  double largest = 0.0;
  for (std::size_t node = 0; node < stiffness.size(); ++node) {
    const double squared_frequency = stiffness[node] / mass[node];
    if (squared_frequency <= largest) continue;
    largest = squared_frequency;
    stiffest_node_ = static_cast<int>(node);
    if (!std::isfinite(largest)) break;
  }
  return largest;
}

std::vector<double> Elements::nodal_stiffness(std::span<const Vec3> x) {
  std::vector<double> stiffness(nodal_volume_.size(), 0.0);
#pragma omp parallel num_threads(threads())
  {
    for (const auto& group : groups_) {
      const int batches = group->batches();
#pragma omp for schedule(static) nowait
      for (int batch = 0; batch < batches; ++batch) group->bound_stiffness(batch, x);
    }
#pragma omp barrier
#pragma omp for schedule(static)
    for (std::size_t node = 0; node < stiffness.size(); ++node) {
      for (int k = first_slot_[node]; k < first_load_[node]; ++k) stiffness[node] += *stiffness_[k];
    }
  }
  return stiffness;
}

double Elements::elastic_energy(std::span<const Vec3> x) const {
  double sum = 0.0;
  for (const auto& group : groups_) sum += group->elastic_energy(x);
  return sum;
}

std::array<double, 2> Elements::volume_ratio_range(std::span<const Vec3> x) const {
  std::array<double, 2> range{INFINITY, -INFINITY};
  for (const auto& group : groups_) {
    const auto [smallest, largest] = group->volume_ratio_range(x);
    range = {std::min(range[0], smallest), std::max(range[1], largest)};
  }
  return range;
}

}  // namespace drogue::fem
