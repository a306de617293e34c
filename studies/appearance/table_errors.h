#pragma once

// Comparison of a reflection table with the photometer at random views.

#include <cstdint>
#include <optional>
#include <vector>

#include "raytrace/observers/photometric_geometry.h"
#include "studies/appearance/reflection_table.h"

namespace retrace::studies {

/// Number of random views at which a grid or the finished table is compared with the photometer.
inline constexpr std::uint32_t kProbes = 200;
/// Seed of all random numbers of the study. Each use has a stream of its own.
inline constexpr std::uint32_t kAppearanceSeed = 0x6d61746cU;
/// Minimum reference of relative errors, as a fraction of the maximum value for the same light.
inline constexpr double kErrorFloor = 0.01;

/// Returns the relative error of the interpolated value `interpolated` compared with the true value `reference`. If
/// `reference` is below kErrorFloor times the maximum `maximum`, the error is relative to this product.
double error_of(double interpolated, double reference, double maximum);

double quantile(std::vector<double> errors, double fraction);

/// Returns the 95 % quantile of the errors. This quantile must be below the requested error.
double percentile_95_of(const std::vector<double>& errors);

/// Returns the deviation of a random view from the central direction of the table.
/// \param x random number for the first component
/// \param y random number for the second component
geometry::Vec2 random_deviation(const ReflectionTable& table, std::uint32_t x, std::uint32_t y);

/// Returns the directions to source and observer. Returns nothing if the deviation is too large for a unit vector.
std::optional<raytrace::PhotometricDirections> view_at(const ReflectionTable& table, const geometry::Vec3& to_source,
                                                       const geometry::Vec2& deviation);

/// Returns the maximum of R_A over the view grid of the table, for the eye's response and one direction of light.
double max_r_a(const ReflectionTable& table, const geometry::Vec3& to_source);

}  // namespace retrace::studies
