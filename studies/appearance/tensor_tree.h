#pragma once

// Converts a reflection table to a tensor tree, which is the content of Radiance's BSDF files with variable resolution.

#include <cstdint>
#include <utility>
#include <vector>

#include "studies/appearance/reflection_table.h"

namespace retrace::studies {

/// BRDF over the directions of light and view. The x and y components of a direction are a point in the unit disc.
/// Shirley and Chiu's map converts this point to a point in the unit square. For light, the direction is -to_source;
/// for view, it is to_observer. Equal areas of the square are equal projected solid angles; the area of the whole
/// square corresponds to pi. Leaves are hypercubes with the side 2^-level. The BRDF is 0 outside the listed leaves.
struct TensorTree {
  int level = 0;
  /// Numbers and values of all leaves that are not 0, in ascending order. The hexadecimal digits of a number are the
  /// branches from the root, the most significant first. Bit k of a digit selects the half of the branch along
  /// dimension k; the two dimensions of light come first.
  std::vector<std::pair<std::uint64_t, double>> leaves;

  /// Returns the width of a leaf, in components of a unit vector at normal incidence.
  double leaf_width() const;
};

/// Returns the mean BRDF of each leaf, weighted by the eye's response. It is 0 for light outside the range of the
/// table. The side of a leaf is 2^-8, or more if the table is coarser. (P. Shirley and K. Chiu, Journal of Graphics
/// Tools 2 (3), 45, 1997)
TensorTree tensor_tree_of(const ReflectionTable& table);

}  // namespace retrace::studies
