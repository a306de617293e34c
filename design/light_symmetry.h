#pragma once

// Symmetries of a design and its illumination: transformations of directions that leave all optical results unchanged.

#include <Eigen/Core>
#include <vector>

#include "design/design.h"
#include "design/optical_model.h"

namespace retrace::design {

/// Returns the orthogonal maps of directions in the plane z = 0 that change neither the part, nor its optical
/// properties, nor the polarisation of its light. The first is the identity. If such a map takes one direction of
/// incidence to another one, it also takes the results of the first direction to those of the second. Only one of them
/// has to be traced.
///
/// Only the identity is returned for balls, curved entrance faces, elements with different media behind them, facets
/// with a form or a height map, scratches with one azimuth, and light whose Stokes parameter u or v is not 0. If only q
/// is not 0, the maps are the reflections of x and y and their product, because they do not change q
/// (raytrace::source_axis()).
std::vector<Eigen::Matrix2d> light_symmetries(const Design& design, const OpticalModel& model);

}  // namespace retrace::design
