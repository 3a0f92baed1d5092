// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/shape_reader.hpp"

#include "app/value.hpp"

namespace drogue::app {

namespace {

Vec3 centre(Section& s) { return s.get<Vec3>("centre", {.unit = "m", .doc = "of the body, before it moves"}); }
int axis(Section& s) { return s.choose("axis", axes, {.doc = "along which a cylinder extends"}); }
int normal(Section& s) { return s.choose("normal", axes, {.doc = "of a plate or a disk"}); }
double diameter(Section& s) {
  return s.get<double>("diameter", {.unit = "m", .doc = "of a sphere, cylinder or disk", .range = positive});
}
double length(Section& s) { return s.get<double>("length", {.unit = "m", .doc = "of a cylinder", .range = positive}); }
geometry::Ends ends(Section& s) {
  return s.choose<geometry::Ends>(
      "ends", {{"capped", geometry::Ends::capped}, {"open", geometry::Ends::open}},
      {.doc = "of a cylinder; open where it spans a periodic direction", .fallback = "capped"});
}
Pair size(Section& s) {
  return s.get<Pair>(
      "size",
      {.unit = "m", .doc = "edges of a plate, along the axes that follow the normal cyclically", .range = positive});
}

geometry::Shape sphere(Section& s) {
  const Vec3 at = centre(s);
  return geometry::sphere(at, diameter(s));
}

geometry::Shape cylinder(Section& s) {
  const Vec3 at = centre(s);
  const int along = axis(s);
  const double d = diameter(s), l = length(s);
  return geometry::cylinder(at, along, d, l, ends(s));
}

geometry::Shape plate(Section& s) {
  const Vec3 at = centre(s);
  const int across = normal(s);
  return geometry::plate(at, across, size(s));
}

geometry::Shape disk(Section& s) {
  const Vec3 at = centre(s);
  const int across = normal(s);
  return geometry::disk(at, across, diameter(s));
}

/// The one list of shapes.
using Reader = geometry::Shape (*)(Section&);
const Choices<Reader> shapes{{"sphere", sphere}, {"cylinder", cylinder}, {"plate", plate}, {"disk", disk}};

}  // namespace

geometry::Shape read_shape(Section section) {
  const Reader read = section.choose("type", shapes, {.doc = "of a rigid body, given by its dimensions"});
  if (section.describing()) {
    for (const auto& [name, reader] : shapes) reader(section);
  }
  return read(section);
}

}  // namespace drogue::app
