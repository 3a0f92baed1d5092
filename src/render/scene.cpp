// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/scene.hpp"

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkDataSetSurfaceFilter.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkImageDataGeometryFilter.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyDataNormals.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"

namespace drogue::render {
namespace {

constexpr double most_points = 40e6;  // of the grid an iso-surface is extracted from: 160 MB

vtkSmartPointer<vtkUnstructuredGrid> read_canopy(const std::filesystem::path& file) {
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  vtkSmartPointer<vtkUnstructuredGrid> grid = reader->GetOutput();
  if (reader->GetErrorCode() != 0 || grid->GetNumberOfCells() == 0)
    throw InputError(fmt::format("{} is not a canopy file", file.string()));
  return grid;
}

vtkSmartPointer<vtkPolyData> canopy_surface(const std::filesystem::path& file) {
  const auto grid = read_canopy(file);
  vtkDataArray* displacement = grid->GetPointData()->GetArray("Displacement");
  if (!displacement) throw InputError(fmt::format("{} has no point data Displacement", file.string()));
  vtkNew<vtkFloatArray> along_x;
  along_x->SetName(displacement_name);
  along_x->SetNumberOfTuples(grid->GetNumberOfPoints());
  for (vtkIdType n = 0; n < grid->GetNumberOfPoints(); ++n)
    along_x->SetValue(n, static_cast<float>(displacement->GetComponent(n, 0)));
  grid->GetPointData()->SetScalars(along_x);

  vtkNew<vtkDataSetSurfaceFilter> surface;
  surface->SetInputData(grid);
  vtkNew<vtkPolyDataNormals> normals;  // smooth over the faces, sharp at the rim
  normals->SetInputConnection(surface->GetOutputPort());
  normals->SetFeatureAngle(60.0);
  normals->Update();
  return normals->GetOutput();
}

/// Points `spacing` apart that span the box; one layer along an axis without extent.
PointGrid grid_over(const Box& box, double spacing) {
  PointGrid grid{box.lower, spacing, {}};
  for (int a = 0; a < 3; ++a) grid.size[a] = 1 + static_cast<int>(std::lround(box.size()[a] / spacing));
  return grid;
}

vtkSmartPointer<vtkImageData> image(const FlowField& field, const PointGrid& grid, const char* name) {
  auto result = vtkSmartPointer<vtkImageData>::New();
  result->SetOrigin(grid.lower.x(), grid.lower.y(), grid.lower.z());
  result->SetSpacing(grid.spacing, grid.spacing, grid.spacing);
  result->SetDimensions(grid.size[0], grid.size[1], grid.size[2]);
  const std::vector<float> values = field.sample(grid);
  vtkNew<vtkFloatArray> scalars;
  scalars->SetName(name);
  scalars->SetNumberOfTuples(static_cast<vtkIdType>(values.size()));
  std::copy(values.begin(), values.end(), scalars->GetPointer(0));
  result->GetPointData()->SetScalars(scalars);
  return result;
}

Box intersection(const Box& a, const Box& b) { return {a.lower.cwiseMax(b.lower), a.upper.cwiseMin(b.upper)}; }

vtkSmartPointer<vtkPolyData> slice(const FlowField& field, const Choice& choice, Box region) {
  region = intersection(region, field.domain());
  const int axis = choice.plane_axis;
  if (choice.plane_position < field.domain().lower[axis] || choice.plane_position > field.domain().upper[axis])
    throw InputError(fmt::format("the plane {} = {} m lies outside the domain, which reaches from {} to {} m",
                                 "xyz"[axis], choice.plane_position, field.domain().lower[axis],
                                 field.domain().upper[axis]));
  region.lower[axis] = region.upper[axis] = choice.plane_position;
  vtkNew<vtkImageDataGeometryFilter> geometry;
  geometry->SetInputData(image(field, grid_over(region, field.finest_spacing()), quantity_name(choice.field)));
  geometry->Update();
  return geometry->GetOutput();
}

vtkSmartPointer<vtkPolyData> iso_surface(const FlowField& q, const FlowField& colour, const Choice& choice,
                                         const Box& region) {
  const FlowField::Reach reach = q.reach(choice.q);
  const Box box = intersection(reach.box, region);
  if ((box.size().array() <= 0.0).any()) return vtkSmartPointer<vtkPolyData>::New();
  double spacing = reach.spacing;
  while (box.size().prod() / std::pow(spacing, 3) > most_points) spacing *= 2.0;

  vtkNew<vtkFlyingEdges3D> contour;
  contour->SetInputData(image(q, grid_over(box, spacing), "Q"));
  contour->SetValue(0, choice.q);
  contour->ComputeNormalsOn();
  contour->ComputeScalarsOff();
  contour->Update();
  vtkSmartPointer<vtkPolyData> surface = contour->GetOutput();
  vtkNew<vtkFloatArray> scalars;
  scalars->SetName(quantity_name(choice.field));
  scalars->SetNumberOfTuples(surface->GetNumberOfPoints());
  for (vtkIdType n = 0; n < surface->GetNumberOfPoints(); ++n) {
    Vec3 point;
    surface->GetPoint(n, point.data());
    scalars->SetValue(n, colour.at(point));
  }
  surface->GetPointData()->SetScalars(scalars);
  return surface;
}

/// Upstream of the canopies a little, downstream the near wake; everything if there is no canopy.
Box near_wake(const std::vector<vtkSmartPointer<vtkPolyData>>& canopies, const Box& domain) {
  if (canopies.empty()) return domain;
  Box box{Vec3::Constant(1e300), Vec3::Constant(-1e300)};
  for (const auto& canopy : canopies) {
    const double* bounds = canopy->GetBounds();
    box.lower = box.lower.cwiseMin(Vec3(bounds[0], bounds[2], bounds[4]));
    box.upper = box.upper.cwiseMax(Vec3(bounds[1], bounds[3], bounds[5]));
  }
  const double length = box.size().tail<2>().maxCoeff();
  box.lower -= length * Vec3(1.0, 0.6, 0.6);
  box.upper += length * Vec3(4.0, 0.6, 0.6);
  return box;
}

}  // namespace

const char* quantity_name(Quantity quantity) {
  switch (quantity) {
    case Quantity::speed:
      return "speed [m/s]";
    case Quantity::vorticity:
      return "vorticity [1/s]";
    case Quantity::q_criterion:
      return "Q [1/s^2]";
  }
  return "";
}

double read_canopy_time(const std::filesystem::path& file) {
  const auto grid = read_canopy(file);
  vtkDataArray* time = grid->GetFieldData()->GetArray("TimeValue");
  return time ? time->GetComponent(0, 0) : 0.0;
}

Scene load_scene(const RunFolder& run, double time, const Content& content, const Choice& choice) {
  const auto frames = [&](const std::vector<Frame>& all, const char* kind) {
    if (all.empty()) throw InputError(fmt::format("{} holds no {} snapshots", run.folder.string(), kind));
    return nearest(all, time);
  };
  const bool flow = content.slice || content.q;
  Scene scene;
  if (flow) time = frames(run.fluid, "fluid").front().time;  // the flow is saved less often: the canopy follows it
  if (content.canopy || !run.canopy.empty())
    for (const Frame& frame : frames(run.canopy, "canopy")) {
      scene.canopy.push_back(canopy_surface(frame.file));
      scene.time = frame.time;
    }
  if (flow) {
    const Frame frame = frames(run.fluid, "fluid").front();
    scene.time = frame.time;
    const io::FluidSnapshot snapshot = io::read_fluid(frame.file);
    const FlowField field(snapshot, choice.field);
    const Box region = choice.region.value_or(near_wake(scene.canopy, field.domain()));
    if (content.slice) scene.slice = slice(field, choice, region);
    if (content.q) scene.q = iso_surface(FlowField(snapshot, Quantity::q_criterion), field, choice, region);
  }
  if (!content.canopy) scene.canopy.clear();
  return scene;
}

}  // namespace drogue::render
