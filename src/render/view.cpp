// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/view.hpp"

#include <fmt/format.h>
#include <vtkCamera.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/error.hpp"

namespace drogue::render {
namespace {

constexpr double view_angle = 24.0;  // [degrees] from top to bottom
constexpr double margin = 1.05;

}  // namespace

View named_view(const std::string& name, const Content& content) {
  if (name == "iso") return {{-0.55, 0.45, 1.0}, Vec3::UnitY()};
  if (name == "back") return {{0.8, 0.45, 1.0}, Vec3::UnitY()};
  if (name == "upstream") return {-Vec3::UnitX(), Vec3::UnitY(), true};
  if (name == "downstream") return {Vec3::UnitX(), Vec3::UnitY(), true};
  if (name == "side") return {Vec3::UnitZ(), Vec3::UnitY(), true};
  if (name == "top") return {Vec3::UnitY(), -Vec3::UnitZ(), true};
  if (name == "auto") return named_view(content.q ? "iso" : content.slice ? "side" : "back", content);
  throw InputError(
      fmt::format("view \"{}\" is not known; expected auto, iso, back, upstream, downstream, side or top", name));
}

// Perspective enlarges what is near, so the middle of the boxes is not the middle of their picture: distance and aim
// are improved in turn, which settles in a few rounds.
void fit(vtkCamera* camera, const std::vector<Vec3>& points, const View& view, double aspect) {
  const Vec3 back = view.from.normalized(), right = view.up.cross(back).normalized(), up = back.cross(right);
  const double tangent = std::tan(0.5 * view_angle * M_PI / 180.0);
  Vec3 aim = Vec3::Zero();
  for (const Vec3& p : points) aim += p / static_cast<double>(points.size());

  double distance = 0.0, half_height = 0.0;
  for (int round = 0; round < 8; ++round) {
    distance = half_height = 0.0;
    for (const Vec3& p : points) {
      const double needed = margin * std::max(std::abs((p - aim).dot(right)) / aspect, std::abs((p - aim).dot(up)));
      half_height = std::max(half_height, needed);
      distance = std::max(distance, needed / tangent + (p - aim).dot(back));
    }
    Eigen::Array2d low = Eigen::Array2d::Constant(1e300), high = -low;
    for (const Vec3& p : points) {
      const double depth = view.parallel ? 1.0 : distance - (p - aim).dot(back);
      const Eigen::Array2d place((p - aim).dot(right) / depth, (p - aim).dot(up) / depth);
      low = low.min(place);
      high = high.max(place);
    }
    const Eigen::Array2d shift = 0.5 * (low + high) * (view.parallel ? 1.0 : distance);
    if (round < 7) aim += shift[0] * right + shift[1] * up;
  }
  const Vec3 eye = aim + distance * back;
  camera->SetFocalPoint(aim.x(), aim.y(), aim.z());
  camera->SetPosition(eye.x(), eye.y(), eye.z());
  camera->SetViewUp(up.x(), up.y(), up.z());
  camera->SetViewAngle(view_angle);
  camera->SetParallelProjection(view.parallel);
  camera->SetParallelScale(half_height);
}

}  // namespace drogue::render
