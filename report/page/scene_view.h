#pragma once

// Prepares the part with its light paths for the interactive view of the page.

#include "report/page/page.h"
#include "studies/scene/scene.h"

namespace retrace::report {

/// A scene as the page shows it, what happens on each path in words.
SceneView scene_view(const studies::DesignScene& scene);

}  // namespace retrace::report
