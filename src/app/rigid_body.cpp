// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/rigid_body.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "app/wake.hpp"
#include "io/canopy.hpp"

namespace drogue::app {

namespace {

constexpr double stride = 4.0;  // finest cells between the places of a body that moves

const RigidBody& rigid(const Body& body) { return std::get<RigidBody>(body.kind); }

std::array<Vec3, 8> corners_around(const std::vector<Vec3>& points) {
  Vec3 lower = points.front(), upper = lower;
  for (const Vec3& p : points) {
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
  std::array<Vec3, 8> corners;
  for (int i = 0; i < 8; ++i) {
    corners[i] = {i & 1 ? upper.x() : lower.x(), i & 2 ? upper.y() : lower.y(), i & 4 ? upper.z() : lower.z()};
  }
  return corners;
}

/// The farthest that a corner is away from where it is in the other pose.
double distance(const std::array<Vec3, 8>& corners, const ib::Pose& a, const ib::Pose& b) {
  double largest = 0.0;
  for (const Vec3& corner : corners) largest = std::max(largest, (a(corner) - b(corner)).norm());
  return largest;
}

}  // namespace

std::vector<Vec3> places_of(const Case& c, const RigidBody& body) {
  const bool still = body.motion.is_still();
  const std::vector<Vec3> at_rest = body.shape.sample(still ? c.finest : stride * c.finest).point;
  const std::array<Vec3, 8> corners = corners_around(at_rest);
  std::vector<ib::Pose> poses{body.motion.pose(0.0)};
  for (double time = 0.0; !still && time <= c.end; time += time_step(c, 0)) {
    const ib::Pose pose = body.motion.pose(time);
    const auto is_near = [&](const ib::Pose& other) { return distance(corners, pose, other) < stride * c.finest; };
    if (std::ranges::none_of(poses, is_near)) poses.push_back(pose);
  }
  std::vector<Vec3> places;
  for (const ib::Pose& pose : poses) {
    for (const Vec3& point : at_rest) places.push_back(pose(point));
  }
  return places;
}

CoupledRigidBody::CoupledRigidBody(const Case& c, const Body& body, const amr::Forest& forest)
    : CoupledBody(body),
      body_(forest, rigid(body).shape, rigid(body).motion, rigid(body).coupling),
      flow_direction_(flow_direction(c)) {}

BodyRow CoupledRigidBody::measure(const fluid::FluidSolver* fluid) {
  const ib::Pose pose = body_.motion().pose(fluid->time());
  const ib::Slip slip = body_.slip(fluid->fine_velocity());
  const ib::Load load = body_.take_mean_load();
  BodyRow row;
  row.force = load.force;
  row.torque = load.torque;
  row.centre = pose(body_.surface().enclosed.centre);
  row.slip_rms = slip.rms;
  row.slip_max = slip.max;
  if (has_wake(description)) row.wake_length = wake_length(*fluid);
  return row;
}

/// In widths, from the point of the surface that lies farthest downstream.
double CoupledRigidBody::wake_length(const fluid::FluidSolver& fluid) const {
  const ib::Pose pose = body_.motion().pose(fluid.time());
  const Vec3 centre = pose(body_.surface().enclosed.centre);
  double rear = 0.0;
  for (const Vec3& p : body_.surface().point) rear = std::max(rear, (pose(p) - centre).dot(flow_direction_));
  return app::wake_length(fluid, centre + rear * flow_direction_, flow_direction_) / rigid(description).shape.width;
}

void CoupledRigidBody::write(const std::filesystem::path& file, double time) const {
  const geometry::TriangleMesh& picture = body_.surface().picture;
  const ib::Pose pose = body_.motion().pose(time);
  std::vector<Vec3> position;
  for (const Vec3& p : picture.points) position.push_back(pose(p));
  io::write_surface(file, picture, position, time);
}

std::string CoupledRigidBody::report(const Case& c) const {
  const geometry::Surface& surface = body_.surface();
  const double area = std::accumulate(surface.area.begin(), surface.area.end(), 0.0);
  const double spacing = std::sqrt(area / static_cast<double>(surface.point.size())) / c.finest;
  const auto& [shape, key, motion, coupling] = rigid(description);
  std::string text = fmt::format(
      "body    {}: rigid, {} markers {:.3g} cells apart on {:.4g} m^2, {:.3g} cells within the surface\n"
      "        enclosing {:.4g} m^3; reference area {:.4g} m^2\n",
      description.name, surface.point.size(), spacing, area, coupling.retraction, surface.enclosed.volume,
      description.reference_area);
  if (shape.width > 0.0) {
    text += fmt::format("        {:.4g} finest cells across its width of {} m\n", shape.width / c.finest, shape.width);
  }
  return text;
}

}  // namespace drogue::app
