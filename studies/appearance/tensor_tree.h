#pragma once

// A reflection table as a tensor tree: the leaves of Radiance's BSDF files of variable resolution.

#include <cstdint>
#include <utility>
#include <vector>

#include "studies/appearance/reflection_table.h"

namespace retrace::studies {

/// BRDF over light and view, each a place in the unit square that Shirley and Chiu's map makes of the unit disc of a
/// direction's x and y: of light those of -to_source, of view those of to_observer. Equal areas of the square are equal
/// projected solid angles, pi for all of it. Leaves are hypercubes of side 2^-level; what is not among them is 0.
struct TensorTree {
  int level = 0;
  /// Number and value of every leaf that is not 0, rising. The number's hexadecimal digits, the first most significant,
  /// are the branches from the root: bit k says in which half along dimension k, light's two dimensions first.
  std::vector<std::pair<std::uint64_t, double>> leaves;

  /// Extent of a leaf, as a share of a unit vector at normal incidence.
  double leaf_width() const;
};

/// The mean BRDF over each leaf, weighed by the eye, of light that the table holds; of other light it is 0. Leaves are
/// as fine as 2^-8, or coarser where the table is. (P. Shirley and K. Chiu, Journal of Graphics Tools 2 (3), 45, 1997)
TensorTree tensor_tree_of(const ReflectionTable& table);

}  // namespace retrace::studies
