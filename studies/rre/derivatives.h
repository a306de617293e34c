#pragma once

// Derivatives of RRE with respect to parameters of a design, computed with the exact engine.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/math/derivative.h"
#include "core/progress.h"
#include "design/design.h"
#include "design/optical_model.h"
#include "raytrace/exact/beam_tracer.h"

namespace retrace::studies {

/// Parameters with respect to which RRE is differentiated. The size is that of the whole element: base and width of a
/// prism in proportion, or the aperture of a cube corner. Gaps, margins and the lengths of the array do not change. The
/// apex angle applies to prisms. For cube corners, the dihedral errors of all edges change by the same amount.
enum class RreParameter { size_mm, apex_angle_deg, dihedral_error_deg, refractive_index, thickness_mm, incidence_deg };

/// Returns the key of a parameter in files, with its unit.
std::string_view parameter_name(RreParameter parameter);

/// Returns the parameters that apply to a design.
std::vector<RreParameter> parameters_of(const design::Design& design);

/// Returns the keys of a design that together represent a parameter. Empty for the incidence.
std::vector<std::string> keys_of(RreParameter parameter, const design::Design& design);

/// Returns the value of a parameter in a design.
/// \pre the parameter applies to the design, and the design itself contains its value; this excludes the refractive
/// index of a named material
double value_of(const design::Design& design, RreParameter parameter);

/// Returns the design with another value of a parameter.
/// \pre see value_of()
/// \throw InputError if the design with this value is invalid
design::Design with(const design::Design& design, RreParameter parameter, double value);

/// Reason why the derivative of RRE with respect to a parameter is not available.
enum class NoDerivative {
  count_changes,    ///< the number of elements of the part changes near the value of the parameter
  too_many_beams,   ///< tracing the part at nearby values of the parameter needs too many beams
  no_part,          ///< the part cannot be built at nearby values of the parameter
  truncated_power,  ///< the truncated power causes too much noise in the derivative
  not_smooth        ///< RRE has a kink or a discontinuity near the value of the parameter
};
/// Returns the reason as a clause for use in messages, such as "no part can be built nearby".
std::string_view text_of(NoDerivative reason);

/// Derivative of RRE with respect to one parameter. The name of the parameter contains its unit.
struct RreDerivative {
  RreParameter parameter = RreParameter::incidence_deg;
  Derivative derivative;
  std::optional<NoDerivative> missing_reason;  ///< reason why the derivative is missing; none if `derivative` is valid
};

/// Direction of incidence of a design, with the result of tracing it.
struct TracedDirection {
  const design::Design& design;
  const design::OpticalModel& model;
  const raytrace::BeamTracer& tracer;  ///< tracer of model.part
  raytrace::Illumination illumination;
  raytrace::BeamPolicy policy;         ///< policy of every evaluation, with a limit of 20 times the point's beams
  const raytrace::BeamResult& traced;  ///< result for the design's acceptance cones
};

/// Computes the derivatives of RRE for each acceptance cone, in the order of parameters_of(). Truncated power counts as
/// noise. A derivative is omitted with a reason if RRE has a kink or a discontinuity, if noise hides the derivative, or
/// if it needs too many beams. Several parameters are computed in parallel; the result does not depend on the number of
/// threads. Returns nothing if the computation was cancelled.
std::optional<std::vector<std::vector<RreDerivative>>> rre_derivatives(const TracedDirection& at,
                                                                       const Cancellation* cancel);

}  // namespace retrace::studies
