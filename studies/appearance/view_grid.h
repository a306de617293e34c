#pragma once

// Grids of R_A over the view directions, for single directions of light.

#include <vector>

#include "requests/part.h"
#include "studies/appearance/colour_photometer.h"
#include "studies/appearance/reflection_table.h"

namespace retrace::studies {

/// Returns the initial number of grid points along a side.
/// \param table table with its range of directions
std::size_t first_columns(const MaterialRequest& request, const ReflectionTable& table);

/// Computes the grid of a table for one direction of light.
std::vector<Rgb> grid_of(const ReflectionTable& table, const geometry::Vec3& to_source, const ColourFields& fields,
                         const raytrace::ApertureKernel& kernel, const Cancellation* cancel);

/// Increases the number of grid points until interpolation between view directions is accurate enough. The accuracy is
/// tested with one direction of light at the centre of the ranges of entrance angle and azimuth. Returns false if the
/// computation was cancelled.
/// \param error requested relative error of the table
bool refine_grid(const ColourPhotometer& photometer, double error, ReflectionTable& table, const Cancellation* cancel);

}  // namespace retrace::studies
