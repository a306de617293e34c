#include "studies/rre/derivatives.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <utility>
#include <variant>

#include "core/error.h"
#include "core/schema/writer.h"
#include "core/threads.h"
#include "design/io/design_reader.h"
#include "design/io/part_reader.h"
#include "geometry/elements/element_cells.h"
#include "geometry/elements/ruled_pattern.h"

namespace retrace::studies {
namespace {

using geometry::PartSpec, geometry::RtpElement, raytrace::Account;

/// Rounding error of RRE from the exact engine. It does not include the error due to truncated light.
constexpr double kRounding = 1e-12;
constexpr double kArcminPerDeg = 60.0;

double size_of(const geometry::Element& element) {
  if (const auto* rtp = std::get_if<RtpElement>(&element)) return rtp->base_mm;
  if (const auto* hexagonal = std::get_if<geometry::HexagonalCube>(&element)) return hexagonal->aperture_mm;
  if (const auto* round = std::get_if<geometry::RoundCube>(&element)) return round->diameter_mm;
  if (const auto* ruled = std::get_if<geometry::RuledCells>(&element))
    return geometry::aperture_of_mean_cell_mm(*ruled->pattern);
  return std::get<geometry::TriangularCube>(element).aperture_mm;
}

/// Returns the mean of the three dihedral errors of a cube corner.
double mean_dihedral_error_deg(const PartSpec& spec) {
  const auto& errors = spec.angle_errors.dihedral_error_arcmin;
  return (errors[0] + errors[1] + errors[2]) / (3.0 * kArcminPerDeg);
}

bool is_round(const PartSpec& spec) {
  return std::holds_alternative<geometry::RoundCube>(spec.element);
}

/// Returns true if the design specifies its dihedral angle errors in arc seconds.
bool is_in_arcsec(const design::Design& design) {
  return design.document && design.document->has(design::kDihedralErrorArcsec);
}

/// Returns the values of the keys that represent a parameter, in the order of the keys.
std::vector<schema::Value> values_at(const design::Design& design, RreParameter parameter, double value) {
  const PartSpec& spec = design.part();
  if (parameter == RreParameter::dihedral_error_deg) {
    const double more_deg = value - mean_dihedral_error_deg(spec);
    std::vector<double> errors(spec.angle_errors.dihedral_error_arcmin.begin(),
                               spec.angle_errors.dihedral_error_arcmin.end());
    for (double& error : errors) error = (error + kArcminPerDeg * more_deg) * (is_in_arcsec(design) ? 60.0 : 1.0);
    return {errors};
  }
  if (parameter == RreParameter::thickness_mm && is_round(spec))
    return {value + geometry::element_depth_mm(spec.element)};
  const auto* const prism = std::get_if<RtpElement>(&spec.element);
  if (parameter == RreParameter::size_mm && prism != nullptr)
    return {value, prism->width_mm * (value / prism->base_mm)};
  return {value};
}

double value_of(const TracedDirection& at, RreParameter parameter) {
  if (parameter == RreParameter::refractive_index) return at.model.optics.index;
  if (parameter == RreParameter::incidence_deg) return at.illumination.incidence.deg();
  return value_of(at.design, parameter);
}

/// Summary of one trace.
struct Traced {
  std::vector<double> rre;  ///< indexed by acceptance cone
  double truncated = 0.0;
  /// Amount by which `rre` and `truncated` vary irregularly between traces at neighbouring values of a parameter.
  double noise = 0.0;

  Sample rre_sample(std::size_t cone) const { return {rre[cone], noise}; }
  Sample truncated_sample() const { return {truncated, noise}; }
};

/// Returns the summary of a trace with its noise. With a fixed cut-off, a small change of a parameter moves only a few
/// beams across the cut-off, and each has less power than the cut-off. If the cut-off is determined in every trace, all
/// truncated power may vary.
Traced summary_of(const raytrace::BeamResult& traced, const raytrace::BeamPolicy& policy) {
  constexpr double kBeamsAtATime = 10.0;
  Traced summary;
  for (const raytrace::Ledger& ledger : traced.ledgers) summary.rre.push_back(ledger[Account::retroreflected]);
  summary.truncated = traced.ledgers.front()[Account::truncated];
  const double most = std::abs(summary.truncated);
  summary.noise = (policy.cutoff ? std::min(most, kBeamsAtATime * *policy.cutoff) : most) + kRounding;
  return summary;
}

/// Returns the range and the first step of the finite differences. RRE is mostly smooth over this step. The step is
/// larger if much power is truncated, because noise is divided by the step. The extrapolation of the differences
/// detects where RRE is not smooth.
DifferenceRange range_of(const TracedDirection& at, RreParameter parameter) {
  constexpr double kOpen = 1e-9;  // distance from an end that does not belong to the range
  constexpr double kLoud = 1e-9;
  const double wider = std::clamp(std::cbrt(summary_of(at.traced, at.policy).noise / kLoud), 1.0, 4.0);
  const double relative_step = 0.01 * wider;
  const double value = value_of(at, parameter);
  // An error of the angle between facets deflects light by about three times this error. Therefore light soon leaves a
  // narrow cone.
  const double angle_step = std::min(0.05 * wider, 0.1 * at.design.detector.acceptance_half_angle_deg.front());
  switch (parameter) {
    case RreParameter::size_mm: return {relative_step * value, kOpen * value};
    case RreParameter::apex_angle_deg: return {angle_step, 60.0, 120.0};
    case RreParameter::dihedral_error_deg: return {angle_step};
    case RreParameter::refractive_index: return {relative_step, 1.0};
    case RreParameter::thickness_mm: return {relative_step * value, at.model.part.top_mm + kOpen * value};
    case RreParameter::incidence_deg: return {0.25 * wider, -90.0 + kOpen, 90.0 - kOpen};
  }
  return {};
}

/// Returns the numbers of full and partial elements for an element size. Returns nothing if the design with this size
/// is invalid.
std::optional<std::pair<std::int64_t, std::int64_t>> count_elements(const design::Design& design, double size_mm) {
  try {
    const geometry::Part part = geometry::build_part(with(design, RreParameter::size_mm, size_mm).part());
    return std::pair{part.elements_full, part.elements_partial};
  } catch (const InputError&) {
    return std::nullopt;
  }
}

/// Halves the first step until the array has the same elements at both ends of the step. Returns false if there is no
/// such step, because RRE is discontinuous at this size.
bool keep_elements(const design::Design& design, double size_mm, DifferenceRange& range) {
  constexpr int kHalvings = 10;
  const auto here = count_elements(design, size_mm);
  const auto same_at = [&](double size) { return count_elements(design, size) == here; };
  for (int k = 0; k <= kHalvings; ++k, range.first_step *= 0.5)
    if (same_at(size_mm - range.first_step) && same_at(size_mm + range.first_step)) return true;
  return false;
}

/// Returns the policy of the point, with a limit on the number of beams in proportion to the number that the point has
/// needed. Without this limit, dozens of traces near normal incidence might each need a million times as many beams.
raytrace::BeamPolicy policy_nearby(const TracedDirection& at) {
  constexpr std::uint64_t kLeast = 200'000;
  constexpr std::uint64_t kTimes = 20;
  raytrace::BeamPolicy policy = at.policy;
  policy.max_beams = std::min(policy.max_beams, std::max(kLeast, kTimes * at.traced.beams));
  return policy;
}

struct Cancelled {};

/// Traces a design as a function of one parameter. Results are kept, because one trace yields the values of all
/// acceptance cones.
class TraceByParameter {
 public:
  TraceByParameter(const TracedDirection& at, RreParameter parameter, const Cancellation* cancel)
      : at_(at), policy_(policy_nearby(at)), parameter_(parameter), cancel_(cancel) {
    known_[value_of(at, parameter)] = summary_of(at.traced, at.policy);
  }

  /// Returns the summary for a value of the parameter.
  /// \throw BudgetError if too many beams are needed
  /// \throw InputError if the part with this value is invalid
  /// \throw Cancelled if the computation was cancelled
  const Traced& operator()(double value) {
    auto known = known_.find(value);
    if (known == known_.end()) known = known_.emplace(value, summary_of(trace(value), at_.policy)).first;
    return known->second;
  }

 private:
  raytrace::BeamResult trace(double value) const {
    raytrace::Optics optics = at_.model.optics;
    raytrace::Illumination illumination = at_.illumination;
    if (parameter_ == RreParameter::incidence_deg)
      illumination.incidence = Angle::from_deg(value);
    else if (parameter_ == RreParameter::refractive_index)
      optics.index = value;
    else
      return trace(geometry::build_part(with(at_.design, parameter_, value).part()));
    return trace(at_.tracer, optics, illumination);
  }

  raytrace::BeamResult trace(const geometry::Part& part) const {
    return trace(raytrace::BeamTracer(part), at_.model.optics, at_.illumination);
  }

  raytrace::BeamResult trace(const raytrace::BeamTracer& tracer, const raytrace::Optics& optics,
                             const raytrace::Illumination& illumination) const {
    raytrace::BeamResult traced =
        tracer.trace(optics, illumination, at_.design.detector.acceptance_half_angle_deg, policy_, cancel_);
    if (!traced.complete) throw Cancelled{};
    return traced;
  }

  const TracedDirection& at_;
  raytrace::BeamPolicy policy_;
  RreParameter parameter_;
  const Cancellation* cancel_;
  std::map<double, Traced> known_;
};

std::optional<NoDerivative> why_not(const Derivative& derivative) {
  if (derivative.converged()) return {};
  // If the noise is above this fraction of the error of the derivative, it is reported as the reason. The error also
  // grows with the noise.
  constexpr double kShows = 0.2;
  return derivative.noise > kShows * derivative.error ? NoDerivative::truncated_power : NoDerivative::not_smooth;
}

/// Returns the derivatives with respect to one parameter, one for each acceptance cone.
std::vector<RreDerivative> derivatives_by(RreParameter parameter, const TracedDirection& at,
                                          const Cancellation* cancel) {
  const std::size_t cones = at.design.detector.acceptance_half_angle_deg.size();
  const auto left_out = [&](NoDerivative reason) {
    return std::vector<RreDerivative>(cones, RreDerivative{parameter, {}, reason});
  };
  DifferenceRange range = range_of(at, parameter);
  const double value = value_of(at, parameter);
  if (parameter == RreParameter::size_mm && !keep_elements(at.design, value, range))
    return left_out(NoDerivative::count_changes);
  TraceByParameter trace(at, parameter, cancel);
  std::vector<RreDerivative> derivatives;
  try {
    // The truncated power also varies with the parameter. RRE may lack all of this power. Therefore the
    // derivative of this power bounds the error of the derivative of RRE.
    const double truncation =
        at.policy.cutoff
            ? std::abs(differentiate([&](double x) { return trace(x).truncated_sample(); }, value, range).value)
            : 0.0;
    for (std::size_t cone = 0; cone < cones; ++cone) {
      Derivative found = differentiate([&](double x) { return trace(x).rre_sample(cone); }, value, range);
      found.error += truncation;
      found.noise += truncation;
      derivatives.push_back({parameter, found, why_not(found)});
    }
  } catch (const BudgetError&) {
    return left_out(NoDerivative::too_many_beams);
  } catch (const InputError&) {
    return left_out(NoDerivative::no_part);
  }
  return derivatives;
}

}  // namespace

std::string_view text_of(NoDerivative reason) {
  switch (reason) {
    case NoDerivative::count_changes:
      return "the number of elements of the array changes for slightly different values";
    case NoDerivative::too_many_beams: return "slightly different values require far more beams";
    case NoDerivative::no_part: return "no part can be built for slightly different values";
    case NoDerivative::truncated_power: return "the truncated power makes this derivative too inaccurate";
    case NoDerivative::not_smooth:
      return "RRE has a kink or a jump at this value, so that the derivative does not exist";
  }
  return "";
}

std::string_view parameter_name(RreParameter parameter) {
  switch (parameter) {
    case RreParameter::size_mm: return "size_mm";
    case RreParameter::apex_angle_deg: return "apex_angle_deg";
    case RreParameter::dihedral_error_deg: return "dihedral_error_deg";
    case RreParameter::refractive_index: return "refractive_index";
    case RreParameter::thickness_mm: return "thickness_mm";
    case RreParameter::incidence_deg: return "incidence_deg";
  }
  return "";
}

std::vector<RreParameter> parameters_of(const design::Design& design) {
  if (std::holds_alternative<geometry::RuledCells>(design.part().element))
    return {RreParameter::refractive_index, RreParameter::thickness_mm, RreParameter::incidence_deg};
  const bool is_prism = std::holds_alternative<RtpElement>(design.part().element);
  return {RreParameter::size_mm, is_prism ? RreParameter::apex_angle_deg : RreParameter::dihedral_error_deg,
          RreParameter::refractive_index, RreParameter::thickness_mm, RreParameter::incidence_deg};
}

std::vector<std::string> keys_of(RreParameter parameter, const design::Design& design) {
  switch (parameter) {
    case RreParameter::size_mm:
      if (std::holds_alternative<RtpElement>(design.part().element)) return {"element.base_mm", "element.width_mm"};
      return {is_round(design.part()) ? "element.diameter_mm" : "element.aperture_mm"};
    case RreParameter::apex_angle_deg: return {"element.apex_angle_deg"};
    case RreParameter::dihedral_error_deg:
      return {std::string(is_in_arcsec(design) ? design::kDihedralErrorArcsec : design::kDihedralErrorArcmin)};
    case RreParameter::refractive_index: return {"body.refractive_index"};
    case RreParameter::thickness_mm: return {is_round(design.part()) ? "element.length_mm" : "body.thickness_mm"};
    case RreParameter::incidence_deg: break;
  }
  return {};
}

double value_of(const design::Design& design, RreParameter parameter) {
  const PartSpec& spec = design.part();
  if (parameter == RreParameter::size_mm) return size_of(spec.element);
  if (parameter == RreParameter::apex_angle_deg) return std::get<RtpElement>(spec.element).apex_angle_deg;
  if (parameter == RreParameter::dihedral_error_deg) return mean_dihedral_error_deg(spec);
  return spec.thickness_mm;
}

design::Design with(const design::Design& design, RreParameter parameter, double value) {
  const std::vector<std::string> keys = keys_of(parameter, design);
  const std::vector<schema::Value> values = values_at(design, parameter, value);
  std::vector<std::string> overrides;
  for (std::size_t k = 0; k < keys.size(); ++k) overrides.push_back(schema::override_text(keys[k], values[k]));
  return design::with(design, overrides);
}

std::optional<std::vector<std::vector<RreDerivative>>> rre_derivatives(const TracedDirection& at,
                                                                       const Cancellation* cancel) {
  const std::vector<RreParameter> parameters = parameters_of(at.design);
  std::vector<std::vector<RreDerivative>> by_parameter(parameters.size());
  std::atomic<bool> cancelled{false};
  for_each_in_parallel(parameters.size(), [&](std::size_t k) {
    try {
      by_parameter[k] = derivatives_by(parameters[k], at, cancel);
    } catch (const Cancelled&) {
      cancelled = true;
    }
  });
  if (cancelled) return std::nullopt;
  std::vector<std::vector<RreDerivative>> by_cone(at.design.detector.acceptance_half_angle_deg.size());
  for (const std::vector<RreDerivative>& cones : by_parameter)
    for (std::size_t cone = 0; cone < cones.size(); ++cone) by_cone[cone].push_back(cones[cone]);
  return by_cone;
}

}  // namespace retrace::studies
