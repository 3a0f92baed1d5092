// SPDX-License-Identifier: GPL-3.0-or-later
#include "lbm/boundary.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "lbm/d3q19.hpp"
#include "lbm/level_transfer.hpp"
#include "lbm/lines.hpp"

namespace drogue::lbm {
namespace {

constexpr int n = amr::block_size;

bool fixes_velocity(const fluid::Face& face) {
  return face.type == fluid::Boundary::velocity || face.type == fluid::Boundary::no_slip;
}

bool radiates(const fluid::Face& face) {
  return !face.reflecting && (face.type == fluid::Boundary::velocity || face.type == fluid::Boundary::outlet);
}

/// Is the velocity on this face given by a formula that differs from cell to cell or in time?
bool needs_table(const fluid::Face& face) {
  if (!fixes_velocity(face)) return false;
  for (const Expression& e : face.velocity)
    if (!e.is_constant()) return true;
  return false;
}

bool depends_on_time(const fluid::Face& face) {
  for (const Expression& e : face.velocity)
    if (e.depends_on_time()) return true;
  return false;
}

}  // namespace

template <class S>
BoundaryFill<S>::BoundaryFill(const amr::Forest& forest, const fluid::Specification& specification, const Units& units)
    : forest_(forest), specification_(specification), units_(units), items_(forest.levels()), edges_(forest.levels()) {
  for (int level = 0; level < forest.levels(); ++level) {
    const auto range = forest.range(level, amr::Kind::boundary);
    for (int id = range.begin; id < range.end; ++id) add(level, id);
  }
}

template <class S>
void BoundaryFill<S>::add(int level, int id) {
  const std::vector<int> faces = forest_.faces_beyond(id);
  if (faces.size() == 3) return;
  Item item = item_at(id, faces);
  const fluid::Face& face = specification_.face[item.face];
  if (needs_table(face)) {
    item.table = static_cast<int>(tables_.size());
    tables_.emplace_back();
    update_table(item, 0.0);
  } else if (fixes_velocity(face)) {
    for (int a = 0; a < 3; ++a)
      item.velocity[a] = broadcast(static_cast<Real>(face.velocity[a](Vec3::Zero(), 0.0) / units_.velocity));
  }
  if (faces.size() == 1 && radiates(face)) {
    item.memory = static_cast<int>(memories_.size());
    memories_.emplace_back();
  }
  items_[level][faces.size() - 1].push_back(item);
  if (faces.size() == 2) add_wall_edge(level, id, faces);
}

/// Without table, memory and constant velocity.
template <class S>
auto BoundaryFill<S>::item_at(int id, const std::vector<int>& faces) const -> Item {
  const auto& face = specification_.face;
  const int level = forest_.block(id).level;
  Item item{};
  item.face = faces.back();
  for (const int f : faces)
    if (!radiates(face[f])) item.face = f;
  for (const int f : faces) item.beyond_wall |= f != item.face && fixes_velocity(face[f]);
  const int axis = item.face / 2, inwards = item.face & 1 ? -1 : 1;
  Index3 source = forest_.block(id).index;
  source[axis] += inwards;
  item.along = along_axis(axis);
  item.across = across_axis(axis);
  if (faces.size() == 2) {
    const int other = faces[faces[0] == item.face] / 2;
    if (other == item.along) std::swap(item.along, item.across);
  }
  item.count = faces.size() == 1 ? n : 1;
  item.to = id;
  for (const int f : faces) item.to_first[f / 2] = f & 1 ? 0 : n - 1;
  item.from = {forest_.find(level, source), item.to_first, false};
  item.from.first[axis] = n - 1 - item.to_first[axis];
  // of ghosts and parents what is mirrored is in rows, see RimJob::copy
  const amr::Kind kind = forest_.block(item.from.block).kind;
  item.from.in_columns =
      kind == amr::Kind::leaf ? axis == 0 : kind == amr::Kind::boundary && forest_.is_beyond(item.from.block, 0);
  item.table = item.memory = -1;
  item.density = static_cast<Real>(face[item.face].pressure / units_.pressure);
  const double cells = forest_.domain().box.size()[axis] / forest_.spacing(level);
  item.open = {axis, static_cast<Real>(-inwards), static_cast<Real>(half_relaxation(cells))};
  return item;
}

/// If it is an edge between walls of which one is without slip, and a leaf lies in it.
template <class S>
void BoundaryFill<S>::add_wall_edge(int level, int id, const std::vector<int>& faces) {
  int sticking = 0;
  Index3 outward{0, 0, 0};
  for (const int f : faces) {
    const fluid::Boundary type = specification_.face[f].type;
    if (type != fluid::Boundary::no_slip && type != fluid::Boundary::free_slip) return;
    sticking += type == fluid::Boundary::no_slip;
    outward[f / 2] = f & 1 ? 1 : -1;
  }
  const int o = faces[0] / 2, p = faces[1] / 2;
  WallEdge edge{3 - o - p, {}};
  for (int i = 0; i < 4; ++i) {
    Sender& sender = edge.sender[i];
    Index3 offset{0, 0, 0};
    for (const auto& [axis, beyond] : {std::pair{o, i / 2 == 1}, std::pair{p, i % 2 == 1}}) {
      offset[axis] = beyond ? 0 : -outward[axis];
      sender.place.first[axis] = (outward[axis] > 0) == beyond ? 0 : n - 1;
      sender.direction[axis] = beyond ? -outward[axis] : outward[axis];
    }
    const int block = forest_.block(id).neighbour[amr::neighbour_slot(offset[0], offset[1], offset[2])];
    if (i == 0 && (sticking == 0 || forest_.block(block).kind != amr::Kind::leaf)) return;
    sender.place.block = block;
    sender.place.in_columns = is_in_columns(forest_, block, sender.place.first, edge.along);
  }
  edges_[level].push_back(edge);
}

template <class S>
void BoundaryFill<S>::start(int level, const MomentField<S>& field) {
  for (const Item& item : items_[level][0]) {
    if (item.memory < 0) continue;
    const bool outlet = specification_.face[item.face].type == fluid::Boundary::outlet;
    Index3 from = item.from.first;
    for (int line = 0; line < n; ++line, ++from[item.across]) {
      const Row<Real> inside = field.load_line(item.from.block, from, item.along, item.from.in_columns);
      memories_[item.memory][line] =
          outlet ? item.open.outlet_memory(inside, item.density) : item.open.inlet_memory(inside);
    }
  }
}

template <class S>
void BoundaryFill<S>::operator()(int level, double time, MomentField<S>& field) {
  for (const auto& items : items_[level]) {
    for (const Item& item : items)
      if (item.table >= 0 && depends_on_time(specification_.face[item.face])) update_table(item, time);
    const int count = static_cast<int>(items.size());
#pragma omp parallel for schedule(static)
    for (int i = 0; i < count; ++i) {
      const Item& item = items[i];
      const double rise = specification_.face[item.face].ramp;
      const double ramp = time < rise ? 0.5 * (1.0 - std::cos(std::numbers::pi * time / rise)) : 1.0;
      Index3 from = item.from.first, to = item.to_first;
      for (int line = 0; line < item.count; ++line, ++from[item.across], ++to[item.across]) {
        const Row<Real> inside = field.load_line(item.from.block, from, item.along, item.from.in_columns);
        field.store_line(item.to, to, item.along, beyond(item, inside, line, static_cast<Real>(ramp)));
      }
    }
  }
}

template <class S>
auto BoundaryFill<S>::beyond(const Item& item, const Row<Real>& inside, int line, Real ramp) -> Row<Real> {
  const fluid::Face& face = specification_.face[item.face];
  const auto velocity = [&] {
    Velocity v = item.table >= 0 ? tables_[item.table][line] : item.velocity;
    for (Vec<Real>& component : v) component *= ramp;
    return v;
  };
  Row<Real> r = inside;
  switch (face.type) {
    case fluid::Boundary::free_slip: {
      static constexpr std::array<std::array<Moment, 3>, 3> flipped{{{ux, pxy, pxz}, {uy, pxy, pyz}, {uz, pxz, pyz}}};
      for (const Moment m : flipped[item.face / 2]) r.m[m] = -r.m[m];
      break;
    }
    case fluid::Boundary::outlet:
      if (item.memory >= 0) return item.open.outlet(inside, item.density, memories_[item.memory][line]);
      if (face.reflecting) r.m[drho] = 2 * item.density - r.m[drho];
      break;
    case fluid::Boundary::velocity:
      if (item.memory >= 0) return item.open.inlet(inside, velocity(), memories_[item.memory][line]);
      [[fallthrough]];
    case fluid::Boundary::no_slip: {
      if (item.beyond_wall) break;
      const Velocity wall = velocity();
      for (int a = 0; a < 3; ++a) r.m[ux + a] = 2 * wall[a] - r.m[ux + a];
      break;
    }
    case fluid::Boundary::periodic:
      break;
  }
  return r;
}

/// With o and p the outward directions of the walls, the cells at the edge send the population o + p across it and get
/// that of -o - p. The image in wall p sends that of o - p, and the other image p - o, past the fluid; on a wall
/// without end others would take their place.
template <class S>
void BoundaryFill<S>::balance(int level, double keep, const MomentField<S>& start, MomentField<S>& end) const {
  const bool third_order = specification_.collision != fluid::Collision::bgk;
  for (const auto& [along, sender] : edges_[level]) {
    const auto sent = [&, along = along](const Sender& s) {
      const auto& [block, first, in_columns] = s.place;
      return population_along(start.load_line(block, first, along, in_columns), static_cast<Real>(keep), third_order,
                              s.direction);
    };
    const Vec<Real> surplus = sent(sender[3]) - sent(sender[2]) - sent(sender[1]) + sent(sender[0]);
    Index3 cell = sender[0].place.first;
    for (; cell[along] < n; ++cell[along]) end.add(sender[0].place.block, cell, drho, -surplus[cell[along]]);
  }
}

template <class S>
void BoundaryFill<S>::update_table(const Item& item, double time) {
  const fluid::Face& face = specification_.face[item.face];
  const Box& domain = forest_.domain().box;
  const int axis = item.face / 2;
  Index3 cell = item.to_first;
  for (int line = 0; line < item.count; ++line, ++cell[item.across])
    for (cell[item.along] = 0; cell[item.along] < n; ++cell[item.along]) {
      Vec3 position = forest_.cell_centre(item.to, cell);
      position[axis] = item.face & 1 ? domain.upper[axis] : domain.lower[axis];
      for (int a = 0; a < 3; ++a)
        tables_[item.table][line][a][cell[item.along]] =
            static_cast<Real>(face.velocity[a](position, time) / units_.velocity);
    }
}

/// What has passed the open faces.
template <class S>
void BoundaryFill<S>::transfer_state(Archive& archive) {
  archive.transfer("memory", std::as_writable_bytes(std::span(memories_)));
}

#ifdef __F16C__
template class BoundaryFill<HalfStress>;
#endif
template class BoundaryFill<FloatStress>;
template class BoundaryFill<DoubleStress>;

}  // namespace drogue::lbm
