// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/picture.hpp"

#include <fmt/format.h>

#include <vtkActor.h>
#include <vtkAxesActor.h>
#include <vtkCamera.h>
#include <vtkCaptionActor2D.h>
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

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/error.hpp"
#include "io/pending_file.hpp"
#include "render/colours.hpp"

namespace drogue::render {
namespace {

constexpr int oversampling = 2;  // pixels are averaged over 2 x 2: smooth edges on any driver
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

void set_style(vtkTextProperty* style, int pixels) {
  style->SetFontFamilyToArial();
  style->SetFontSize(pixels);
  style->SetColor(ink[0], ink[1], ink[2]);
  style->BoldOff();
  style->ItalicOff();
  style->ShadowOff();
}

void add_text(vtkRenderer* renderer, const std::string& text, double x, double y, int pixels, bool centred) {
  vtkNew<vtkTextActor> actor;
  actor->SetInput(text.c_str());
  actor->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
  actor->SetPosition(x, y);
  vtkTextProperty* style = actor->GetTextProperty();
  set_style(style, pixels);
  style->SetVerticalJustificationToTop();
  if (centred) style->SetJustificationToCentered();
  renderer->AddViewProp(actor);
}

void add_colour_bar(vtkRenderer* renderer, vtkLookupTable* colours, const char* title, double bottom, double height,
                    int pixels) {
  vtkNew<vtkScalarBarActor> bar;
  bar->SetLookupTable(colours);
  bar->SetNumberOfLabels(5);
  bar->SetLabelFormat("  %.3g");
  bar->SetMaximumNumberOfColors(256);
  bar->SetBarRatio(0.25);
  bar->UnconstrainedFontSizeOn();
  bar->SetPosition(0.05, bottom);
  bar->SetWidth(0.7);
  bar->SetHeight(height - 2.0 * pixels / renderer->GetRenderWindow()->GetSize()[1]);
  set_style(bar->GetLabelTextProperty(), pixels);
  renderer->AddViewProp(bar);
  add_text(renderer, title, 0.05, bottom + height, pixels, false);
}

/// Range of the lowest `share` of the values: a few extremes at edges should not take the colours from the rest.
Range scalar_range(const std::vector<vtkPolyData*>& surfaces, double share) {
  std::vector<double> values;
  for (vtkPolyData* surface : surfaces)
    for (vtkIdType n = 0; n < surface->GetNumberOfPoints(); ++n)
      values.push_back(surface->GetPointData()->GetScalars()->GetComponent(n, 0));
  if (values.empty()) return round_range(0.0, 0.0);
  const auto highest = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), highest, values.end());
  return round_range(*std::min_element(values.begin(), values.end()), *highest);
}

/// Points of what a row shows of all scenes, enough of them to fit the camera to.
std::vector<Vec3> outline(const std::vector<Scene>& scenes, const Content& content) {
  constexpr vtkIdType enough = 4000;
  std::vector<Vec3> points;
  const auto include = [&](vtkPolyData* surface) {
    const vtkIdType count = surface ? surface->GetNumberOfPoints() : 0;
    for (vtkIdType n = 0; n < count; n += 1 + count / enough) surface->GetPoint(n, points.emplace_back().data());
  };
  for (const Scene& scene : scenes) {
    for (const auto& canopy : scene.canopy)
      if (content.canopy) include(canopy);
    if (content.slice) {
      const double* b = scene.slice->GetBounds();
      for (int corner = 0; corner < 8; ++corner)
        points.emplace_back(b[corner & 1], b[2 + (corner >> 1 & 1)], b[4 + (corner >> 2)]);
    }
    if (content.q) include(scene.q);
  }
  if (points.empty()) points = {Vec3::Constant(-1.0), Vec3::Constant(1.0)};
  return points;
}

/// Small axes, as seen from where the row is seen.
void add_axes(vtkRenderWindow* window, const Rectangle& place, const View& view, int text) {
  const auto renderer = add_renderer(window, place);
  vtkNew<vtkAxesActor> axes;
  axes->SetShaftTypeToCylinder();
  axes->SetCylinderRadius(0.03);
  axes->SetConeRadius(0.25);
  axes->SetNormalizedLabelPosition(1.35, 1.35, 1.35);
  axes->SetXAxisLabelText("x");
  axes->SetYAxisLabelText("y");
  axes->SetZAxisLabelText("z");
  for (vtkCaptionActor2D* caption :
       {axes->GetXAxisCaptionActor2D(), axes->GetYAxisCaptionActor2D(), axes->GetZAxisCaptionActor2D()}) {
    caption->GetTextActor()->SetTextScaleModeToNone();
    set_style(caption->GetCaptionTextProperty(), text * 2 / 3);
  }
  for (vtkProperty* part : {axes->GetXAxisShaftProperty(), axes->GetYAxisShaftProperty(), axes->GetZAxisShaftProperty(),
                            axes->GetXAxisTipProperty(), axes->GetYAxisTipProperty(), axes->GetZAxisTipProperty()})
    part->SetColor(ink[0], ink[1], ink[2]);
  renderer->AddActor(axes);
  fit(renderer->GetActiveCamera(),
      {Vec3::Constant(-0.6), Vec3(1.4, -0.6, -0.6), Vec3(-0.6, 1.4, -0.6), Vec3(-0.6, -0.6, 1.4)}, view, 1.0);
}

struct Colours {
  vtkSmartPointer<vtkLookupTable> displacement, field;  // null where nothing is coloured by it
};

Colours common_colours(const std::vector<Scene>& scenes, Quantity field) {
  std::vector<vtkPolyData*> canopies, slices, isos;
  for (const Scene& scene : scenes) {
    for (const auto& canopy : scene.canopy) canopies.push_back(canopy);
    if (scene.slice) slices.push_back(scene.slice);
    if (scene.q) isos.push_back(scene.q);
  }
  Colours colours;
  if (!canopies.empty()) colours.displacement = lookup_table(ColourMap::embers, scalar_range(canopies, 1.0));
  if (!slices.empty() || !isos.empty())
    colours.field = lookup_table(field == Quantity::speed ? ColourMap::blues_reversed : ColourMap::blues,
                                 scalar_range(slices.empty() ? isos : slices, 0.99));
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

void draw(const std::vector<Scene>& scenes, const Picture& picture, const std::filesystem::path& png) {
  if (!std::getenv("DISPLAY")) throw InputError("no display to draw on: run under \"xvfb-run -a\"");
  const int width = picture.size[0] * oversampling, height = picture.size[1] * oversampling;
  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetSize(width, height);
  window->SetDPI(72);
  window->SetMultiSamples(0);
  window->SetAlphaBitPlanes(1);

  add_renderer(window, {0.0, 0.0, 1.0, 1.0});  // white paper under the panels
  const Colours colours = common_colours(scenes, picture.field);
  const int text = static_cast<int>(std::sqrt(width * height) / 44.0);
  const double strip = add_legend(window, colours, picture.field, text, width);
  const bool sequence = scenes.size() > 1;
  const double header = (sequence ? 4.0 : 2.2) * text / height;  // of the height: title, and times above the columns
  const double gutter = 5.0 * text / width;                      // of the width, for the axes
  const Rectangle area{gutter, 0.0, 1.0 - strip - gutter, 1.0 - header};
  const double panel_width = area.width / scenes.size(), panel_height = area.height / picture.rows.size();

  vtkNew<vtkLightKit> lights;
  lights->SetKeyLightIntensity(0.95);
  for (std::size_t r = 0; r < picture.rows.size(); ++r) {
    const auto& [content, view] = picture.rows[r];
    const std::vector<Vec3> points = outline(scenes, content);
    const double bottom = (picture.rows.size() - 1 - r) * panel_height;
    add_axes(window, {0.0, bottom, gutter, 5.0 * text / height}, view, text);
    for (std::size_t s = 0; s < scenes.size(); ++s) {
      const Rectangle panel{area.left + s * panel_width, bottom, panel_width, panel_height};
      const auto renderer = add_renderer(window, panel);
      add_scene(renderer, scenes[s], content, colours, 0.0016 * height);
      lights->AddLightsToRenderer(renderer);
      fit(renderer->GetActiveCamera(), points, view, panel_width * width / (panel_height * height));
      renderer->ResetCameraClippingRange();
    }
  }
  const auto head = add_renderer(window, {0.0, area.height, 1.0 - strip, header});
  add_text(head, sequence ? picture.title : picture.title + "     " + time_label(scenes[0]), 0.015,
           sequence ? 0.85 : 0.75, text, false);
  for (std::size_t s = 0; sequence && s < scenes.size(); ++s)
    add_text(head, time_label(scenes[s]), (area.left + (s + 0.5) * panel_width) / (1.0 - strip), 0.4, text, true);
  window->Render();
  write_png(window, png);
}

}  // namespace drogue::render
