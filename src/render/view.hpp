// SPDX-License-Identifier: GPL-3.0-or-later
// From where a scene is seen, and a camera as near as the picture allows.
#pragma once

#include <string>
#include <vector>

#include "render/scene.hpp"

class vtkCamera;

namespace drogue::render {

struct View {
  Vec3 from;  ///< direction from the scene to the camera
  Vec3 up;
  bool parallel = false;  ///< parallel projection instead of perspective
};

/// iso, back, upstream, downstream, side, top; or auto: what suits the content. Throws InputError naming the choices.
View named_view(const std::string& name, const Content& content);

/// Places the camera so that the points [m] fill a picture of `aspect` width over height.
void fit(vtkCamera* camera, const std::vector<Vec3>& points, const View& view, double aspect);

}  // namespace drogue::render
