#pragma once

// The map of deviations of a turned surface from its design, with rms and deepest cut.

#include <functional>
#include <optional>
#include <utility>

#include "fabrication/turning/check/inspection.h"

namespace retrace::fabrication::turning {

/// Square to the surface, in nm; nothing where no cut passes.
std::optional<double> deviation_nm(const Envelope& envelope, const geometry::FreeformSurface& design,
                                   const geometry::Vec2& p);

/// Where f is largest between a and b, and its value there; golden section.
std::pair<double, double> largest_between(const std::function<double(double)>& f, double a, double b, int steps);

/// Whether a place is inspected: not at the rim, nor on the spindle's axis.
bool is_inspected(const InspectedRegion& region, const geometry::Vec2& p);

/// Fills the map of the result, its interference and its rms. A pixel shows the greatest deviation, with its sign, over
/// the length of a feed across the cuts at a place drawn within it, found between samples by golden section; of
/// pixels smaller than a quarter of a feed, the greatest at places drawn within them. So cusps finer than pixels do not
/// show as waves that are not there. The rms is that of one place drawn in each pixel. \throw InputError if the
/// programs leave a place of the region uncut
void fill_map(Inspection& result, const Envelope& envelope, const geometry::FreeformSurface& design,
              const InspectedRegion& region, std::size_t pixels);

}  // namespace retrace::fabrication::turning
