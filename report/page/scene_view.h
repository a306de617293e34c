#pragma once

// Prepares the part with its light paths for the interactive view of the page.

#include "report/page/page.h"
#include "report/page/result_folder.h"
#include "studies/scene/scene.h"

namespace retrace::report {

/// Converts a scene (a design with light paths) to the content of the view. The events of each path become text.
SceneView scene_view(const studies::DesignScene& scene);

/// Adds a three-dimensional view of the design to a page. It shows light paths for directions that occur in the
/// results. If the view cannot be made, the page keeps its other content.
/// \return reasons why there is no view
Warnings add_scene(Page& page, const ResultFolder& folder);

/// Adds a section in which the design can be changed. No section is added if the design refers to files, or if the
/// results do not contain the design.
void add_live(Page& page, const ResultFolder& folder);

}  // namespace retrace::report
