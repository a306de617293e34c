#pragma once

// Prepares the part with its light paths for the interactive view of the page.

#include "report/page/page.h"
#include "report/page/result_folder.h"
#include "studies/scene/scene.h"

namespace retrace::report {

/// A scene as the page shows it, what happens on each path in words.
SceneView scene_view(const studies::DesignScene& scene);

/// Gives a page the view of the design that its results quote, in the light that they are of. A page without its view
/// is better than none. \return why it has none, if so
Warnings add_scene(Page& page, const ResultFolder& folder);

/// Gives a page a section in which the design that its results quote can be changed; none of one that names files, or
/// that results do not quote.
void add_live(Page& page, const ResultFolder& folder);

}  // namespace retrace::report
