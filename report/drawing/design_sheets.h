#pragma once

// Makes drawing sheets of a design as SVG: plan and section with dimension lines.

#include <string>

#include "studies/drawing/design_drawing.h"

namespace retrace::report {

/// Returns the plan as an SVG document with dimension lines. The plan shows the whole part and, if the elements are
/// small compared with the part, an enlarged detail. The groups `plan-0` and `plan-1` have attributes with the position
/// of their origin and the number of units per mm (`data-x-mm`, `data-y-mm`, `data-units-per-mm`). The y axis of the
/// page points down. Equal drawings give equal bytes.
std::string plan_svg(const studies::DesignDrawing& drawing);

/// Returns the section as an SVG document, like plan_svg(). Its group is `section-0`, with the attribute `data-z-mm`
/// instead of `data-y-mm`. The central part of a plate that is much thicker than the elements is omitted.
/// \pre drawing.section has a value
std::string section_svg(const studies::DesignDrawing& drawing);

/// Returns the text of a dimension: its name and its value with six digits.
std::string dimension_text(const studies::Dimension& dimension);

}  // namespace retrace::report
