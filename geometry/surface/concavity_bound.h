#pragma once

// Proves that the curvature of a concave surface is below a limit everywhere.

#include <functional>

#include "geometry/surface/lenslet.h"

namespace retrace::geometry {

/// Rectangle in plan.
struct PlanBox {
  Vec2 low_mm = Vec2::Zero();
  Vec2 high_mm = Vec2::Zero();
};

/// Calls `holds` for a box. If it returns false, the box is divided into quarters, up to `depth` times. The smallest
/// boxes for which `holds` still returns false are passed to `on_failure`.
void prove_by_subdivision(const PlanBox& box, int depth, const std::function<bool(const PlanBox&)>& holds,
                          const std::function<void(const PlanBox&)>& on_failure);

/// Proves by interval arithmetic, box by box, that the second derivative of a sag is below a limit in every direction.
/// \param limit_per_mm limit for d2z/ds2, where s is the length in plan
/// \param is_needed returns false for boxes that can be ignored
/// \param on_failure is called for each smallest box for which the proof failed
void bound_concavity(const Sag& sag, const PlanBox& box, double limit_per_mm,
                     const std::function<bool(const PlanBox&)>& is_needed,
                     const std::function<void(const PlanBox&)>& on_failure);

/// Returns true if the limit is proved for a lenslet inside its inner boundary, in the part frame.
bool is_concavity_bounded(const Lenslet& lenslet, double limit_per_mm);

/// Returns true if the limit is proved for the blend between a lenslet and the base.
bool is_blend_concavity_bounded(const Lenslet& lenslet, const Sag& base, double limit_per_mm);

}  // namespace retrace::geometry
