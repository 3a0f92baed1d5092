// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <fstream>

#include "core/error.hpp"
#include "io/canopy.hpp"
#include "render/picture.hpp"
#include "synthetic_run.hpp"
#include "temporary_folder.hpp"

namespace drogue {
namespace {

using render::FlowField;
using render::Quantity;
using test::FormulaFluid;
using test::TemporaryFolder;
using test::VortexRings;

io::FluidSnapshot snapshot_of(const FormulaFluid& fluid, const TemporaryFolder& folder) {
  io::write_fluid(folder / "fluid_000001.vtkhdf", fluid);
  return io::read_fluid(folder / "fluid_000001.vtkhdf");
}

/// A canopy at two instants and a flow at the second.
void write_run(const TemporaryFolder& folder) {
  const fem::Mesh mesh = test::square_plate(12);
  const std::vector<Vec3> rest(mesh.nodes.size(), Vec3::Zero());
  io::write_canopy(folder / "canopy_000000.vtu", mesh, mesh.nodes, rest, {}, 0.0);
  io::write_canopy(folder / "canopy_000001.vtu", mesh, test::dome(mesh, 0.3), rest, {}, 0.5);
  io::write_fluid(folder / "fluid_000001.vtkhdf", FormulaFluid(test::plate_forest(3), {}, 0.5));
}

// Linear interpolation between cell centres, level changes included, is exact for linear fields.
TEST(FlowField, linear_fields_are_reproduced_across_levels) {
  const TemporaryFolder folder("flow_linear");
  io::FluidSnapshot snapshot = snapshot_of(FormulaFluid(test::plate_forest(3), {}, 0.0), folder);
  const auto formula = [](const Vec3& p) { return 20.0 + p.x() + 2.0 * p.y() - 0.5 * p.z(); };
  for (auto& level : snapshot.levels)
    for (std::size_t n = 0; n < level.velocity.size() / 3; ++n) {
      const Index3& block = level.block[n / amr::block_cells];
      const int cell = static_cast<int>(n % amr::block_cells);
      const Vec3 index(block[0] * 16 + cell % 16 + 0.5, block[1] * 16 + cell / 16 % 16 + 0.5,
                       block[2] * 16 + cell / 256 + 0.5);
      level.velocity[3 * n] = static_cast<float>(formula(snapshot.origin + level.spacing * index));
      level.velocity[3 * n + 1] = level.velocity[3 * n + 2] = 0.0f;
    }
  const FlowField speed(snapshot, Quantity::speed);
  for (double x = -1.8; x < 5.8; x += 0.093)
    for (double y = -1.8; y < 1.8; y += 0.17) {
      const Vec3 p(x, y, 0.37 * y + 0.1);
      ASSERT_NEAR(speed.at(p), formula(p), 1e-4) << p.transpose();
    }
  // curl (u(x, y, z), 0, 0) = (0, du/dz, -du/dy), away from the domain's faces where cells lack a neighbour
  const FlowField vorticity(snapshot, Quantity::vorticity);
  for (double x = -1.0; x < 5.0; x += 0.13) ASSERT_NEAR(vorticity.at({x, 0.3, 0.2}), std::hypot(2.0, 0.5), 2e-3) << x;
}

// On the core line of a ring A has its maximum, so vorticity is A (4 / core^2 + 1 / R^2) and Q a quarter of its square.
// Central differences and linear interpolation each lose about (dx / core)^2 of the vorticity there.
TEST(FlowField, derived_quantities_of_a_vortex_converge_to_theory) {
  const TemporaryFolder folder("flow_vortex");
  const VortexRings ring;
  const io::FluidSnapshot snapshot = snapshot_of(FormulaFluid(test::plate_forest(4), ring, 0.0), folder);
  const Vec3 core(ring.centre[0], ring.radius, 0.0);
  const double expected = ring.strength * (4.0 / (ring.core * ring.core) + 1.0 / (ring.radius * ring.radius));
  const double vorticity = FlowField(snapshot, Quantity::vorticity).at(core);
  const double q = FlowField(snapshot, Quantity::q_criterion).at(core);
  const double loss = std::pow(1.0 / 64 / ring.core, 2);
  EXPECT_NEAR(vorticity, expected, 3.0 * loss * expected);
  EXPECT_NEAR(q, 0.25 * expected * expected, 6.0 * loss * 0.25 * expected * expected);
}

TEST(Canopy, vtk_reads_the_mesh_and_its_arrays) {
  const TemporaryFolder folder("canopy_vtk");
  const fem::Mesh mesh = test::square_plate(3);
  const std::vector<Vec3> position = test::dome(mesh, 0.2), velocity(mesh.nodes.size(), Vec3(1.0, 2.0, 3.0));
  const std::vector<double> energy(mesh.hexahedra.size(), 0.25);
  io::write_canopy(folder / "canopy.vtu", mesh, position, velocity, {{"energy [J] <&>", energy}}, 0.75);

  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName((folder / "canopy.vtu").c_str());
  reader->Update();
  vtkUnstructuredGrid* grid = reader->GetOutput();
  ASSERT_EQ(grid->GetNumberOfPoints(), static_cast<vtkIdType>(mesh.nodes.size()));
  ASSERT_EQ(grid->GetNumberOfCells(), static_cast<vtkIdType>(mesh.hexahedra.size()));
  EXPECT_EQ(grid->GetCellType(0), VTK_HEXAHEDRON);
  for (vtkIdType n = 0; n < grid->GetNumberOfPoints(); ++n)
    for (int a = 0; a < 3; ++a) {
      EXPECT_EQ(grid->GetPoint(n)[a], position[n][a]);
      EXPECT_EQ(grid->GetPointData()->GetArray("Displacement")->GetComponent(n, a), position[n][a] - mesh.nodes[n][a]);
      EXPECT_EQ(grid->GetPointData()->GetArray("Velocity")->GetComponent(n, a), velocity[n][a]);
    }
  ASSERT_NE(grid->GetCellData()->GetArray("energy [J] <&>"), nullptr);
  EXPECT_EQ(grid->GetCellData()->GetArray("energy [J] <&>")->GetComponent(0, 0), 0.25);
  EXPECT_EQ(render::read_canopy_time(folder / "canopy.vtu"), 0.75);
}

TEST(RunFolder, frames_are_found_by_name_or_by_list) {
  const TemporaryFolder folder("run_frames");
  EXPECT_THROW(render::open_run(folder.path()), InputError);
  EXPECT_THROW(render::open_run(folder / "missing"), InputError);
  write_run(folder);
  const render::RunFolder found = render::open_run(folder.path());
  ASSERT_EQ(found.canopy.size(), 2u);
  ASSERT_EQ(found.fluid.size(), 1u);
  EXPECT_EQ(found.last_time(), 0.5);
  EXPECT_EQ(render::nearest(found.canopy, 0.2).front().file, folder / "canopy_000000.vtu");

  std::ofstream(folder / "frames.csv") << "kind,index,time[s],file\ncanopy,1,0.25,canopy_000001.vtu\n";
  const render::RunFolder listed = render::open_run(folder.path());
  ASSERT_EQ(listed.canopy.size(), 1u);
  EXPECT_EQ(listed.canopy[0].time, 0.25);
  std::ofstream(folder / "frames.csv") << "kind,index,time[s],file\ncanopy;1\n";
  EXPECT_THROW(render::open_run(folder.path()), InputError);
}

TEST(Picture, shows_canopy_slice_and_vortex) {
  const TemporaryFolder folder("picture");
  write_run(folder);
  const render::RunFolder run = render::open_run(folder.path());
  const render::Content all{true, true, true};
  const render::Scene scene = render::load_scene(run, 0.5, all, {});
  EXPECT_GT(scene.q->GetNumberOfPoints(), 100);
  render::Picture picture{"test", {320, 180}, {{all, render::named_view("auto", all)}}, Quantity::speed};
  render::draw({scene}, picture, folder / "picture.png");

  vtkNew<vtkPNGReader> reader;
  reader->SetFileName((folder / "picture.png").c_str());
  reader->Update();
  vtkImageData* image = reader->GetOutput();
  ASSERT_EQ(image->GetDimensions()[0], 320);
  ASSERT_EQ(image->GetDimensions()[1], 180);
  int warm = 0, blue = 0, white = 0;  // canopy, flow, paper
  for (int y = 0; y < 180; ++y)
    for (int x = 0; x < 260; ++x) {
      const auto* c = static_cast<const unsigned char*>(image->GetScalarPointer(x, y, 0));
      warm += c[0] > c[2] + 60;
      blue += c[2] > c[0] + 60;
      white += c[0] == 255 && c[1] == 255 && c[2] == 255;
    }
  EXPECT_GT(warm, 100);
  EXPECT_GT(blue, 5000);
  EXPECT_GT(white, 5000);
}

TEST(Picture, what_a_run_does_not_hold_is_named) {
  const TemporaryFolder folder("picture_errors");
  write_run(folder);
  std::filesystem::remove(folder / "fluid_000001.vtkhdf");
  const render::RunFolder run = render::open_run(folder.path());
  EXPECT_THROW(render::load_scene(run, 0.5, {true, true, false}, {}), InputError);
  EXPECT_THROW(render::named_view("from above", {}), InputError);
}

}  // namespace
}  // namespace drogue
