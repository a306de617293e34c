#pragma once

// Proofs that a surface is nowhere hollower than a limit.

#include <functional>

#include "geometry/surface/lenslet.h"

namespace retrace::geometry {

/// A rectangle of plan.
struct PlanBox {
  Vec2 low_mm = Vec2::Zero();
  Vec2 high_mm = Vec2::Zero();
};

/// Calls `holds` for a box, and for its quarters where it says no, down to `depth` halvings; those of them where it
/// still says no go to `on_failure`.
void prove_by_quarters(const PlanBox& box, int depth, const std::function<bool(const PlanBox&)>& holds,
                       const std::function<void(const PlanBox&)>& on_failure);

/// Proves by interval arithmetic, box by box, that the second derivative of a sag stays below a limit in every
/// direction. \param limit_per_mm of d2z/ds2, s in plan \param is_needed whether a box matters
/// \param on_failure gets every smallest box where that could not be proved
void bound_concavity(const Sag& sag, const PlanBox& box, double limit_per_mm,
                     const std::function<bool(const PlanBox&)>& is_needed,
                     const std::function<void(const PlanBox&)>& on_failure);

/// The same of a lenslet inside its inner boundary, in the part's frame; whether it was proved.
bool is_concavity_bounded(const Lenslet& lenslet, double limit_per_mm);

/// The same of the blend between a lenslet and the base.
bool is_blend_concavity_bounded(const Lenslet& lenslet, const Sag& base, double limit_per_mm);

}  // namespace retrace::geometry
