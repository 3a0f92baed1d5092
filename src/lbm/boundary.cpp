// SPDX-License-Identifier: GPL-3.0-or-later
#include "lbm/boundary.hpp"

#include <cmath>
#include <numbers>

#include "lbm/d3q19.hpp"

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
    : forest_(forest),
      specification_(specification),
      units_(units),
      items_(forest.levels(), std::vector<std::vector<Item>>(3)),
      edges_(forest.levels()) {
  for (int level = 0; level < forest.levels(); ++level) {
    const auto range = forest.range(level, amr::Kind::boundary);
    for (int id = range.begin; id < range.end; ++id) add(level, id);
  }
}

template <class S>
void BoundaryFill<S>::add(int level, int id) {
  const std::vector<int> faces = forest_.faces_beyond(id);
  const auto& face = specification_.face;
  Item item{id, amr::none, 0, faces.back(), -1, -1, false};
  for (const int f : faces)
    if (!radiates(face[f])) item.face = f;
  item.axis = item.face / 2;
  for (const int f : faces) item.beyond_wall |= f != item.face && fixes_velocity(face[f]);
  Index3 source = forest_.block(id).index;
  source[item.axis] += item.face & 1 ? -1 : 1;
  item.source = forest_.find(level, source);
  if (needs_table(face[item.face])) {
    item.table = static_cast<int>(tables_.size());
    tables_.emplace_back(n);
    update_table(item, 0.0);
  }
  if (faces.size() == 1 && radiates(face[item.face])) {
    item.memory = static_cast<int>(memories_.size());
    memories_.emplace_back();
  }
  items_[level][faces.size() - 1].push_back(item);
  if (faces.size() == 2) add_wall_edge(level, id, faces);
}

/// If it is an edge between walls of which one is without slip, and a leaf lies in it.
template <class S>
void BoundaryFill<S>::add_wall_edge(int level, int id, const std::vector<int>& faces) {
  WallEdge edge{id, {}};
  Index3 inwards{0, 0, 0};
  int sticking = 0;
  for (int i = 0; i < 2; ++i) {
    const fluid::Boundary type = specification_.face[faces[i]].type;
    const int axis = faces[i] / 2;
    if (type != fluid::Boundary::no_slip && type != fluid::Boundary::free_slip) return;
    sticking += type == fluid::Boundary::no_slip;
    edge.outward[i][axis] = faces[i] & 1 ? 1 : -1;
    inwards[axis] = -edge.outward[i][axis];
  }
  const int inner = forest_.block(id).neighbour[amr::neighbour_slot(inwards[0], inwards[1], inwards[2])];
  if (sticking > 0 && forest_.block(inner).kind == amr::Kind::leaf) edges_[level].push_back(edge);
}

template <class S>
void BoundaryFill<S>::start(int level, const MomentField<S>& field) {
  for (const Item& item : items_[level][0]) {
    if (item.memory < 0) continue;
    const bool outlet = specification_.face[item.face].type == fluid::Boundary::outlet;
    const OpenFace<Real> open = open_face(item);
    for (int line = 0; line < n; ++line) {
      const Row<Real> inside = load_layer(field.block(item.source), item, item.face & 1 ? n - 1 : 0, line);
      memories_[item.memory][line] = outlet ? open.outlet_memory(inside, far_density(item)) : open.inlet_memory(inside);
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
      const bool high = item.face & 1;
      for (int line = 0; line < n; ++line) {
        const Row<Real> inside = load_layer(field.block(item.source), item, high ? n - 1 : 0, line);
        store_layer(field.block(item.target), item, high ? 0 : n - 1, line, beyond(item, inside, line, ramp));
      }
    }
  }
}

template <class S>
auto BoundaryFill<S>::load_layer(const std::byte* block, const Item& item, int depth, int line) -> Row<Real> {
  using Layout = RowLayout<S>;
  if (item.axis == 0) return Layout::load_column(block, depth, line * n, 1);
  return Layout::load_row(block + (item.axis == 1 ? line * n + depth : depth * n + line) * Layout::bytes);
}

template <class S>
void BoundaryFill<S>::store_layer(std::byte* block, const Item& item, int depth, int line, const Row<Real>& r) {
  using Layout = RowLayout<S>;
  if (item.axis == 0) return Layout::store_column(block, depth, line * n, 1, r);
  Layout::store_row(block + (item.axis == 1 ? line * n + depth : depth * n + line) * Layout::bytes, r);
}

template <class S>
auto BoundaryFill<S>::beyond(const Item& item, const Row<Real>& inside, int line, double ramp) -> Row<Real> {
  const fluid::Face& face = specification_.face[item.face];
  Row<Real> r = inside;
  switch (face.type) {
    case fluid::Boundary::free_slip: {
      static constexpr std::array<std::array<Moment, 3>, 3> flipped{{{ux, pxy, pxz}, {uy, pxy, pyz}, {uz, pxz, pyz}}};
      for (const Moment m : flipped[item.axis]) r.m[m] = -r.m[m];
      break;
    }
    case fluid::Boundary::outlet:
      if (item.memory >= 0) return open_face(item).outlet(inside, far_density(item), memories_[item.memory][line]);
      if (face.reflecting) r.m[drho] = 2 * far_density(item) - r.m[drho];
      break;
    case fluid::Boundary::velocity:
      if (item.memory >= 0)
        return open_face(item).inlet(inside, face_velocity(item, line, ramp), memories_[item.memory][line]);
      [[fallthrough]];
    case fluid::Boundary::no_slip: {
      if (item.beyond_wall) break;
      const auto velocity = face_velocity(item, line, ramp);
      for (int a = 0; a < 3; ++a) r.m[ux + a] = 2 * velocity[a] - r.m[ux + a];
      break;
    }
    case fluid::Boundary::periodic:
      break;
  }
  return r;
}

template <class S>
auto BoundaryFill<S>::face_velocity(const Item& item, int line, double ramp) const -> std::array<Vec<Real>, 3> {
  std::array<Vec<Real>, 3> velocity;
  for (int a = 0; a < 3; ++a)
    velocity[a] =
        static_cast<Real>(ramp) *
        (item.table >= 0 ? tables_[item.table][line][a]
                         : broadcast(static_cast<Real>(specification_.face[item.face].velocity[a](Vec3::Zero(), 0.0) /
                                                       units_.velocity)));
  return velocity;
}

template <class S>
auto BoundaryFill<S>::far_density(const Item& item) const -> Real {
  return static_cast<Real>(specification_.face[item.face].pressure / units_.pressure);
}

template <class S>
auto BoundaryFill<S>::open_face(const Item& item) const -> OpenFace<Real> {
  const int level = forest_.block(item.target).level;
  const double cells = forest_.domain().box.size()[item.axis] / forest_.spacing(level);
  return {item.axis, item.face & 1 ? Real(1) : Real(-1), static_cast<Real>(half_relaxation(cells))};
}

/// With o and p the outward directions of the walls, the cells at the edge send the population o + p across it and get
/// that of -o - p. The image in wall p sends that of o - p, and the other image p - o, past the fluid; on a wall
/// without end others would take their place.
template <class S>
void BoundaryFill<S>::balance(int level, double keep, const MomentField<S>& start, MomentField<S>& end) const {
  const bool third_order = specification_.collision != fluid::Collision::bgk;
  for (const auto& [target, outward] : edges_[level]) {
    const auto& [o, p] = outward;
    const int along = o[0] == 0 && p[0] == 0 ? 0 : o[1] == 0 && p[1] == 0 ? 1 : 2;
    const auto at = [&](bool beyond_o, bool beyond_p) {
      struct {
        int block;
        Index3 cell, direction;
      } place;
      Index3 offset;
      for (int a = 0; a < 3; ++a) {
        const int out = o[a] + p[a];
        const bool beyond = o[a] != 0 ? beyond_o : beyond_p;
        offset[a] = beyond ? 0 : -out;
        place.cell[a] = out == 0 || (out > 0) == beyond ? 0 : n - 1;
        place.direction[a] = beyond ? -out : out;
      }
      place.block = forest_.block(target).neighbour[amr::neighbour_slot(offset[0], offset[1], offset[2])];
      return place;
    };
    const auto sent = [&](bool beyond_o, bool beyond_p) {
      const auto [block, cell, direction] = at(beyond_o, beyond_p);
      return population_along(RowLayout<S>::load_line(start.block(block), cell, along), static_cast<Real>(keep),
                              third_order, direction);
    };
    const Vec<Real> surplus = sent(true, true) - sent(true, false) - sent(false, true) + sent(false, false);
    const auto inner = at(false, false);
    for (int i = 0; i < n; ++i) {
      Index3 cell = inner.cell;
      cell[along] = i;
      end.add(inner.block, cell, drho, -surplus[i]);
    }
  }
}

template <class S>
void BoundaryFill<S>::update_table(const Item& item, double time) {
  const fluid::Face& face = specification_.face[item.face];
  const Box& domain = forest_.domain().box;
  for (int line = 0; line < n; ++line)
    for (int lane = 0; lane < n; ++lane) {
      const Index3 cell = item.axis == 0   ? Index3{0, lane, line}
                          : item.axis == 1 ? Index3{lane, 0, line}
                                           : Index3{lane, line, 0};
      Vec3 position = forest_.cell_centre(item.target, cell);
      position[item.axis] = item.face & 1 ? domain.upper[item.axis] : domain.lower[item.axis];
      for (int a = 0; a < 3; ++a)
        tables_[item.table][line][a][lane] = static_cast<Real>(face.velocity[a](position, time) / units_.velocity);
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
