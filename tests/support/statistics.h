#pragma once

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <cstddef>

namespace retrace::testing {

/// Returns the error probability of each of `comparisons` two-sided tests, such that at least one of them fails by
/// chance in 1 % of runs (Sidak 1967).
inline double sidak_level(std::size_t comparisons, double family_level = 0.01) {
  return -std::expm1(std::log1p(-family_level) / static_cast<double>(comparisons));
}

/// Returns the half width of a confidence interval with the confidence 1 - `level`, in standard errors that were
/// estimated from `replicates` (Student's t).
inline double student_bound_of(double level, std::size_t replicates) {
  const boost::math::students_t distribution(static_cast<double>(replicates - 1));
  return boost::math::quantile(boost::math::complement(distribution, 0.5 * level));
}

/// Returns the maximum deviation from the true value, in standard errors that were estimated from `replicates`
/// (Student's t, Sidak-corrected).
inline double student_bound(std::size_t comparisons, std::size_t replicates = 32) {
  return student_bound_of(sidak_level(comparisons), replicates);
}

/// Returns the maximum deviation from the true value in standard errors that are known exactly or from very many
/// samples.
inline double normal_bound(std::size_t comparisons) {
  return boost::math::quantile(boost::math::complement(boost::math::normal(), 0.5 * sidak_level(comparisons)));
}

}  // namespace retrace::testing
