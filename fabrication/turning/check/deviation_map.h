#pragma once

// Computes the map of deviations of a turned surface from its design, with rms and the deepest cut.

#include <functional>
#include <optional>
#include <utility>

#include "fabrication/turning/check/inspection.h"

namespace retrace::fabrication::turning {

/// Returns the deviation of the machined surface from the design at a point, along the surface normal, in nm. Returns
/// nothing where there is no cut.
std::optional<double> deviation_nm(const Envelope& envelope, const geometry::FreeformSurface& design,
                                   const geometry::Vec2& p);

/// Finds the maximum of f between a and b by golden section search.
/// \return the position of the maximum and its value
std::pair<double, double> largest_between(const std::function<double(double)>& f, double a, double b, int steps);

/// Returns true if a point is inspected. Points at the rim and near the spindle's axis are not inspected.
bool is_inspected(const InspectedRegion& region, const geometry::Vec2& p);

/// Computes the map of the result, its interference and its rms. Each pixel of the map contains the deviation with the
/// largest absolute value, with its sign. In pixels larger than a quarter of a feed, this deviation is searched for
/// along a line across the cuts, through a random point of the pixel. The line is one feed long. In smaller pixels, it
/// is searched for among random points. This search avoids aliasing if cusps are finer than pixels. The rms is computed
/// from one random point of each pixel.
/// \throw InputError if the programs leave a part of the region uncut
void fill_map(Inspection& result, const Envelope& envelope, const geometry::FreeformSurface& design,
              const InspectedRegion& region, std::size_t pixels);

}  // namespace retrace::fabrication::turning
