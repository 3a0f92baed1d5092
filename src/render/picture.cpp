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

/// Part of the window, in shares of its size from the lower left corner.
struct Rectangle {
  double left, bottom, width, height;
};

vtkSmartPointer<vtkRenderer> add_renderer(vtkRenderWindow* window, const Rectangle& place) {
  auto renderer = vtkSmartPointer<vtkRenderer>::New();
  renderer->SetViewport(place.left, place.bottom, place.left + place.width, place.bottom + place.height);
  renderer->SetBackground(1.0, 1.0, 1.0);
  renderer->SetUseDepthPeeling(1);
  renderer->SetMaximumNumberOfPeels(12);
  renderer->SetOcclusionRatio(0.0);
  window->AddRenderer(renderer);
  return renderer;
}

std::string time_label(const Scene& scene) { return fmt::format("t = {:.2f} s", scene.time); }

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
  bar->SetNumberOfLabels(5);
  bar->SetLabelFormat("%.3g");
  bar->SetBarRatio(0.25);
  bar->SetTextPad(pixels / 3);
  bar->UnconstrainedFontSizeOn();
  bar->SetPosition(0.05, bottom);
  bar->SetWidth(0.7);
  bar->SetHeight(height - 0.05);
  vtkTextProperty* style = bar->GetLabelTextProperty();
  style->SetFontFamilyToArial();
  style->SetFontSize(pixels);
  style->SetColor(ink[0], ink[1], ink[2]);
  style->BoldOff();
  style->ItalicOff();
  style->ShadowOff();
  renderer->AddViewProp(bar);
  add_text(renderer, title, 0.05, bottom + height, pixels, false);
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

/// The box of what a row shows of all scenes.
Box extent(const std::vector<Scene>& scenes, const Content& content) {
  Box box{Vec3::Constant(1e300), Vec3::Constant(-1e300)};
  const auto include = [&](vtkPolyData* surface) {
    if (!surface || surface->GetNumberOfPoints() == 0) return;
    const double* bounds = surface->GetBounds();
    box.lower = box.lower.cwiseMin(Vec3(bounds[0], bounds[2], bounds[4]));
    box.upper = box.upper.cwiseMax(Vec3(bounds[1], bounds[3], bounds[5]));
  };
  for (const Scene& scene : scenes) {
    for (const auto& canopy : scene.canopy)
      if (content.canopy) include(canopy);
    if (content.slice) include(scene.slice);
    if (content.q) include(scene.q);
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
  if (!canopies.empty()) colours.displacement = lookup_table(ColourMap::embers, scalar_range(canopies));
  if (!slices.empty() || !isos.empty())
    colours.field = lookup_table(ColourMap::blues, scalar_range(slices.empty() ? isos : slices));
  return colours;
}

/// Colour bars in a strip on the right; returns its share of the width.
double add_legend(vtkRenderWindow* window, const Colours& colours, Quantity field, int text, int width) {
  if (!colours.displacement && !colours.field) return 0.0;
  const double strip = std::min(0.3, 8.5 * text / width);
  const auto legend = add_renderer(window, {1.0 - strip, 0.0, strip, 1.0});
  const bool both = colours.displacement && colours.field;
  const double height = both ? 0.4 : 0.5;
  if (colours.displacement)
    add_colour_bar(legend, colours.displacement, displacement_name, both ? 0.53 : 0.25, height, text * 4 / 5);
  if (colours.field)
    add_colour_bar(legend, colours.field, quantity_name(field), both ? 0.05 : 0.25, height, text * 4 / 5);
  return strip;
}

void add_scene(vtkRenderer* renderer, const Scene& scene, const Content& content, const Colours& colours,
               double line_width) {
  for (const auto& canopy : scene.canopy) {
    if (!content.canopy) continue;
    const auto actor = surface_actor(canopy, colours.displacement);
    actor->GetProperty()->SetAmbient(0.25);
    actor->GetProperty()->SetDiffuse(0.85);
    actor->GetProperty()->SetSpecular(0.12);
    actor->GetProperty()->SetSpecularPower(20.0);
    renderer->AddActor(actor);
    renderer->AddActor(rim_actor(canopy, line_width));
  }
  if (content.slice && scene.slice) {
    const auto actor = surface_actor(scene.slice, colours.field);
    actor->GetProperty()->LightingOff();
    renderer->AddActor(actor);
  }
  if (content.q && scene.q) {
    const auto actor = surface_actor(scene.q, colours.field);
    actor->GetProperty()->SetAmbient(0.2);
    actor->GetProperty()->SetDiffuse(0.9);
    actor->GetProperty()->SetSpecular(0.3);
    actor->GetProperty()->SetSpecularPower(30.0);
    actor->GetProperty()->SetOpacity(content.canopy ? 0.6 : 1.0);
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

View named_view(const std::string& name, const Content& content) {
  if (name == "iso") return {{-0.55, 0.45, 1.0}, Vec3::UnitY()};
  if (name == "back") return {{0.8, 0.45, 1.0}, Vec3::UnitY()};
  if (name == "upstream") return {-Vec3::UnitX(), Vec3::UnitY()};
  if (name == "downstream") return {Vec3::UnitX(), Vec3::UnitY()};
  if (name == "side") return {Vec3::UnitZ(), Vec3::UnitY()};
  if (name == "top") return {Vec3::UnitY(), -Vec3::UnitZ()};
  if (name == "auto") return named_view(content.q ? "iso" : content.slice ? "side" : "back", content);
  throw InputError(
      fmt::format("view \"{}\" is not known; expected auto, iso, back, upstream, downstream, side or top", name));
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
  const int text = static_cast<int>(std::sqrt(width * height) / 44.0);
  const double strip = add_legend(window, colours, picture.field, text, width);
  const double header = 1.8 * text / height;  // of the height, for the title
  const Rectangle area{0.0, 0.0, 1.0 - strip, 1.0 - header};
  const double panel_width = area.width / scenes.size(), panel_height = area.height / picture.rows.size();

  vtkNew<vtkLightKit> lights;
  lights->SetKeyLightIntensity(0.95);
  for (std::size_t r = 0; r < picture.rows.size(); ++r) {
    const auto& [content, view] = picture.rows[r];
    const Box box = extent(scenes, content);
    for (std::size_t s = 0; s < scenes.size(); ++s) {
      const Rectangle panel{s * panel_width, (picture.rows.size() - 1 - r) * panel_height, panel_width, panel_height};
      const auto renderer = add_renderer(window, panel);
      add_scene(renderer, scenes[s], content, colours, 0.0016 * height);
      lights->AddLightsToRenderer(renderer);
      fit(renderer->GetActiveCamera(), box, view, panel_width * width / (panel_height * height));
      renderer->ResetCameraClippingRange();
      if (scenes.size() > 1 && r == 0) add_text(renderer, time_label(scenes[s]), 0.5, 1.0, text, true);
    }
  }
  const auto title = add_renderer(window, {0.0, 1.0 - header, 1.0 - strip, header});
  add_text(title, scenes.size() > 1 ? picture.title : picture.title + "     " + time_label(scenes[0]), 0.015, 0.8, text,
           false);
  window->Render();
  write_png(window, png);
}

}  // namespace drogue::render
