// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/picture.hpp"

#include <fmt/format.h>

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkFeatureEdges.h>
#include <vtkImageShrink3D.h>
#include <vtkLightKit.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkPointData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkWindowToImageFilter.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "core/error.hpp"
#include "io/pending_file.hpp"

namespace drogue::render {
namespace {

constexpr int oversampling = 2;  // pixels are averaged over 2 x 2: smooth edges on any driver
constexpr double view_angle = 24.0;
constexpr std::array<double, 3> ink{0.13, 0.15, 0.18};

vtkSmartPointer<vtkActor> surface_actor(vtkPolyData* surface, vtkLookupTable* colours) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(surface);
  mapper->SetLookupTable(colours);
  mapper->UseLookupTableScalarRangeOn();
  mapper->InterpolateScalarsBeforeMappingOn();
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  return actor;
}

vtkSmartPointer<vtkActor> rim_actor(vtkPolyData* surface, double width) {
  vtkNew<vtkFeatureEdges> edges;
  edges->SetInputData(surface);
  edges->BoundaryEdgesOn();  // the normals filter has split the surface along its sharp edges
  edges->FeatureEdgesOff();
  edges->NonManifoldEdgesOff();
  edges->ColoringOff();
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(edges->GetOutputPort());
  mapper->ScalarVisibilityOff();
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(ink[0], ink[1], ink[2]);
  actor->GetProperty()->SetLineWidth(static_cast<float>(width));
  actor->GetProperty()->LightingOff();
  return actor;
}

void add_text(vtkRenderer* renderer, const std::string& text, double x, double y, int pixels, bool centred) {
  vtkNew<vtkTextActor> actor;
  actor->SetInput(text.c_str());
  actor->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
  actor->SetPosition(x, y);
  vtkTextProperty* style = actor->GetTextProperty();
  style->SetFontFamilyToArial();
  style->SetFontSize(pixels);
  style->SetColor(ink[0], ink[1], ink[2]);
  style->SetVerticalJustificationToTop();
  if (centred) style->SetJustificationToCentered();
  renderer->AddViewProp(actor);
}

void add_colour_bar(vtkRenderer* renderer, vtkLookupTable* colours, const char* title, double bottom, double height,
                    int pixels) {
  vtkNew<vtkScalarBarActor> bar;
  bar->SetLookupTable(colours);
  bar->SetTitle(title);
  bar->SetNumberOfLabels(5);
  bar->SetLabelFormat("%.2f");
  bar->SetBarRatio(0.22);
  bar->UnconstrainedFontSizeOn();
  bar->SetPosition(0.08, bottom);
  bar->SetWidth(0.84);
  bar->SetHeight(height);
  for (vtkTextProperty* style : {bar->GetTitleTextProperty(), bar->GetLabelTextProperty()}) {
    style->SetFontFamilyToArial();
    style->SetFontSize(pixels);
    style->SetColor(ink[0], ink[1], ink[2]);
    style->BoldOff();
    style->ItalicOff();
    style->ShadowOff();
  }
  bar->SetVerticalTitleSeparation(pixels / 2);
  renderer->AddViewProp(bar);
}

Range scalar_range(const std::vector<vtkPolyData*>& surfaces) {
  double lowest = 0.0, highest = 0.0;
  for (vtkPolyData* surface : surfaces) {
    if (!surface || surface->GetNumberOfPoints() == 0) continue;
    std::array<double, 2> range;
    surface->GetPointData()->GetScalars()->GetRange(range.data());
    lowest = std::min(lowest, range[0]);
    highest = std::max(highest, range[1]);
  }
  return round_range(lowest, highest);
}

/// The box of everything drawn.
Box extent(const std::vector<Scene>& scenes) {
  Box box{Vec3::Constant(1e300), Vec3::Constant(-1e300)};
  const auto include = [&](vtkPolyData* surface) {
    if (!surface || surface->GetNumberOfPoints() == 0) return;
    const double* bounds = surface->GetBounds();
    box.lower = box.lower.cwiseMin(Vec3(bounds[0], bounds[2], bounds[4]));
    box.upper = box.upper.cwiseMax(Vec3(bounds[1], bounds[3], bounds[5]));
  };
  for (const Scene& scene : scenes) {
    for (const auto& canopy : scene.canopy) include(canopy);
    include(scene.slice);
    include(scene.q);
  }
  return (box.upper.array() < box.lower.array()).any() ? Box{Vec3::Constant(-1.0), Vec3::Constant(1.0)} : box;
}

/// Places the camera as near as it can be with the whole box inside a picture of `aspect` width over height.
void fit(vtkCamera* camera, const Box& box, const View& view, double aspect) {
  const Vec3 back = view.from.normalized(), right = view.up.cross(back).normalized(), up = back.cross(right);
  const double tangent = std::tan(0.5 * view_angle * M_PI / 180.0), margin = 1.06;
  const Vec3 centre = 0.5 * (box.lower + box.upper);
  double distance = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 p;
    for (int a = 0; a < 3; ++a) p[a] = (corner >> a & 1 ? box.upper : box.lower)[a] - centre[a];
    const double needed = std::max(std::abs(p.dot(right)) / (tangent * aspect), std::abs(p.dot(up)) / tangent);
    distance = std::max(distance, margin * needed + p.dot(back));
  }
  const Vec3 eye = centre + distance * back;
  camera->SetFocalPoint(centre.x(), centre.y(), centre.z());
  camera->SetPosition(eye.x(), eye.y(), eye.z());
  camera->SetViewUp(up.x(), up.y(), up.z());
  camera->SetViewAngle(view_angle);
}

struct Colours {
  vtkSmartPointer<vtkLookupTable> displacement, field;  // null where nothing is coloured by it
};

Colours common_colours(const std::vector<Scene>& scenes) {
  std::vector<vtkPolyData*> canopies, slices, isos;
  for (const Scene& scene : scenes) {
    for (const auto& canopy : scene.canopy) canopies.push_back(canopy);
    if (scene.slice) slices.push_back(scene.slice);
    if (scene.q) isos.push_back(scene.q);
  }
  Colours colours;
  if (!canopies.empty()) colours.displacement = lookup_table(ColourMap::viridis, scalar_range(canopies));
  if (!slices.empty() || !isos.empty())
    colours.field = lookup_table(ColourMap::blues, scalar_range(slices.empty() ? isos : slices));
  return colours;
}

void add_scene(vtkRenderer* renderer, const Scene& scene, const Colours& colours, double line_width) {
  for (const auto& canopy : scene.canopy) {
    const auto actor = surface_actor(canopy, colours.displacement);
    actor->GetProperty()->SetSpecular(0.15);
    actor->GetProperty()->SetSpecularPower(20.0);
    renderer->AddActor(actor);
    renderer->AddActor(rim_actor(canopy, line_width));
  }
  if (scene.slice) {
    const auto actor = surface_actor(scene.slice, colours.field);
    actor->GetProperty()->LightingOff();
    renderer->AddActor(actor);
  }
  if (scene.q) {
    const auto actor = surface_actor(scene.q, colours.field);
    actor->GetProperty()->SetSpecular(0.25);
    actor->GetProperty()->SetSpecularPower(30.0);
    actor->GetProperty()->SetOpacity(scene.canopy.empty() ? 1.0 : 0.55);
    renderer->AddActor(actor);
  }
}

void write_png(vtkRenderWindow* window, const std::filesystem::path& png) {
  vtkNew<vtkWindowToImageFilter> grab;
  grab->SetInput(window);
  grab->SetInputBufferTypeToRGB();
  grab->ReadFrontBufferOff();
  vtkNew<vtkImageShrink3D> shrink;
  shrink->SetInputConnection(grab->GetOutputPort());
  shrink->SetShrinkFactors(oversampling, oversampling, 1);
  shrink->MeanOn();
  io::PendingFile pending(png);
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputConnection(shrink->GetOutputPort());
  writer->SetFileName(pending.path().c_str());
  writer->Write();
  if (writer->GetErrorCode() != 0) throw std::runtime_error(fmt::format("cannot write {}", png.string()));
  pending.commit();
}

}  // namespace

View named_view(const std::string& name) {
  if (name == "iso") return {{-0.55, 0.45, 1.0}, Vec3::UnitY()};
  if (name == "upstream") return {-Vec3::UnitX(), Vec3::UnitY()};
  if (name == "downstream") return {Vec3::UnitX(), Vec3::UnitY()};
  if (name == "side") return {Vec3::UnitZ(), Vec3::UnitY()};
  if (name == "top") return {Vec3::UnitY(), -Vec3::UnitZ()};
  throw InputError(fmt::format("view \"{}\" is not known; expected iso, upstream, downstream, side or top", name));
}

void draw(const std::vector<Scene>& scenes, const Picture& picture, const std::filesystem::path& png) {
  if (!std::getenv("DISPLAY")) throw InputError("no display to draw on: run under \"xvfb-run -a\"");
  const int width = picture.size[0] * oversampling, height = picture.size[1] * oversampling;
  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetSize(width, height);
  window->SetDPI(72);
  window->SetMultiSamples(0);
  window->SetAlphaBitPlanes(1);

  const Colours colours = common_colours(scenes);
  const bool bars = colours.displacement || colours.field;
  const int text = std::max(height / 36, 10 * oversampling);
  const double strip = bars ? std::min(0.3, 7.0 * text / width) : 0.0;  // of the width, for the colour bars
  const double panel = (1.0 - strip) / static_cast<double>(scenes.size());
  const Box box = extent(scenes);

  vtkNew<vtkLightKit> lights;
  for (std::size_t s = 0; s < scenes.size(); ++s) {
    vtkNew<vtkRenderer> renderer;
    renderer->SetViewport(panel * static_cast<double>(s), 0.0, panel * static_cast<double>(s + 1), 1.0);
    renderer->SetBackground(1.0, 1.0, 1.0);
    renderer->SetUseDepthPeeling(1);
    renderer->SetMaximumNumberOfPeels(12);
    renderer->SetOcclusionRatio(0.0);
    add_scene(renderer, scenes[s], colours, 0.0016 * height);
    lights->AddLightsToRenderer(renderer);
    fit(renderer->GetActiveCamera(), box, picture.view, panel * width / height);
    renderer->ResetCameraClippingRange();
    const std::string time = fmt::format("t = {:.2f} s", scenes[s].time);
    if (scenes.size() == 1)
      add_text(renderer, picture.title + "    " + time, 0.02, 0.97, text, false);
    else
      add_text(renderer, time, 0.5, 0.9, text, true);
    if (scenes.size() > 1 && s == 0) add_text(renderer, picture.title, 0.03, 0.98, text, false);
    window->AddRenderer(renderer);
  }

  vtkNew<vtkRenderer> legend;
  if (bars) {
    legend->SetViewport(1.0 - strip, 0.0, 1.0, 1.0);
    legend->SetBackground(1.0, 1.0, 1.0);
    const bool both = colours.displacement && colours.field;
    if (colours.displacement)
      add_colour_bar(legend, colours.displacement, displacement_name, both ? 0.53 : 0.25, both ? 0.4 : 0.5,
                     text * 4 / 5);
    if (colours.field)
      add_colour_bar(legend, colours.field, quantity_name(picture.field), both ? 0.06 : 0.25, both ? 0.4 : 0.5,
                     text * 4 / 5);
    window->AddRenderer(legend);
  }
  window->Render();
  write_png(window, png);
}

}  // namespace drogue::render
