// SPDX-License-Identifier: GPL-3.0-or-later
// What a picture shows at one instant, as VTK data: the deformed canopy, a slice of the flow, an iso-surface of Q.
#pragma once

#include <vtkImageData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "render/flow_field.hpp"
#include "render/run_folder.hpp"

namespace drogue::render {

struct Content {
  bool canopy = false, slice = false, q = false;
};

struct Choice {
  Quantity field = Quantity::speed;  ///< colours the slice and the iso-surface
  double q = 40.0;                   ///< [1/s^2]
  int plane_axis = 2;                ///< the slice is the plane x, y or z = plane_position [m]
  double plane_position = 0.0;
  std::optional<Box> region;  ///< of the flow that is shown [m]; default: around the canopy
};

/// Scalars of the points are named as their colour bars: "x displacement [m]", "speed [m/s]", "vorticity [1/s]".
struct Scene {
  double time = 0.0;                                 ///< [s]
  std::vector<vtkSmartPointer<vtkPolyData>> canopy;  ///< one per body
  vtkSmartPointer<vtkPolyData> slice;                ///< null if not asked for
  vtkSmartPointer<vtkPolyData> q;
};

/// Loads the frames nearest to `time` [s]: of the flow if it is asked for, and the canopy nearest to that. Throws
/// InputError if the run has none of a kind that `content` needs.
Scene load_scene(const RunFolder& run, double time, const Content& content, const Choice& choice);

/// The time [s] that a canopy file holds as TimeValue; 0 without.
double read_canopy_time(const std::filesystem::path& file);

inline constexpr const char* displacement_name = "x displacement [m]";
const char* quantity_name(Quantity quantity);

}  // namespace drogue::render
