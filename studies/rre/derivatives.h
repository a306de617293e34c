#pragma once

// Derivatives of RRE by the parameters of a design, from the exact engine.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/math/derivative.h"
#include "core/progress.h"
#include "raytrace/exact/beam_tracer.h"
#include "studies/design/design.h"
#include "studies/design/optical_model.h"

namespace retrace::studies {

/// By what RRE is differentiated. The size is that of an element as a whole: base and width of a prism in proportion,
/// or the aperture of a cube corner; gaps, margins and the lengths of the array stay. Prisms have an apex angle; for
/// cube corners the dihedral errors of all edges change by the same.
enum class RreParameter { size_mm, apex_angle_deg, dihedral_error_deg, refractive_index, thickness_mm, incidence_deg };

/// The key in files, with its unit.
std::string_view parameter_name(RreParameter parameter);

/// Those that a design has.
std::vector<RreParameter> parameters_of(const Design& design);

/// The keys of a design that are that parameter together; none of the incidence.
std::vector<std::string> keys_of(RreParameter parameter, const Design& design);

/// What it is in a design. \pre the design has it, and has a value of its own: not its material's index
double value_of(const Design& design, RreParameter parameter);

/// The design where it has another value. \pre likewise \throw InputError if there is no such design
Design with(const Design& design, RreParameter parameter, double value);

/// The change of RRE with one parameter, per unit of its name.
struct RreDerivative {
  RreParameter parameter = RreParameter::incidence_deg;
  Derivative derivative;
  std::string left_out;  ///< why there is none; empty if there is
};

/// One direction of a design, as it was traced.
struct TracedDirection {
  const Design& design;
  const OpticalModel& model;
  const raytrace::BeamTracer& tracer;  ///< of model.part
  raytrace::Illumination illumination;
  raytrace::BeamPolicy policy;         ///< that every evaluation follows, within a budget of 20 times the point's beams
  const raytrace::BeamResult& traced;  ///< with the design's acceptance cones
};

/// Derivatives of RRE by cone, each in the order of parameters_of(). What the tracer cuts off counts as noise. A
/// derivative is left out, with a reason, where RRE has a kink or a jump, noise hides it, or it would take far more
/// beams. Several parameters at a time; the result does not depend on the threads. Nothing if it was cancelled.
std::optional<std::vector<std::vector<RreDerivative>>> rre_derivatives(const TracedDirection& at,
                                                                       const Cancellation* cancel);

}  // namespace retrace::studies
