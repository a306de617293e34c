#pragma once

// The drawing sheets of a design as SVG: plan and section with dimension lines.

#include <string>

#include "studies/drawing/design_drawing.h"

namespace retrace::report {

/// The plan as an SVG document: the whole and, where elements are small in it, a detail, with dimension lines. Groups
/// `plan-0`, `plan-1` say where their origin lies and how many units a mm has (`data-x-mm`, `data-y-mm`,
/// `data-units-per-mm`); y of the page runs down. The same drawing gives the same bytes.
std::string plan_svg(const studies::DesignDrawing& drawing);

/// The section likewise (`section-0`, with z in place of y). A plate that is thick beside the elements is drawn
/// interrupted. \pre drawing.section
std::string section_svg(const studies::DesignDrawing& drawing);

/// A dimension's text: its name and its value, six digits.
std::string dimension_text(const studies::Dimension& dimension);

}  // namespace retrace::report
