#include "studies/quantity/quantity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <variant>

#include "core/angle.h"
#include "core/error.h"
#include "design/design_part.h"
#include "design/entrance_of_design.h"
#include "design/optical_model.h"
#include "fabrication/job/tool_limits.h"
#include "geometry/elements/element_cells.h"
#include "studies/inspect/inspect.h"
#include "studies/quantity/machine_plan.h"
#include "studies/rre/rre_request.h"

namespace retrace::studies {

std::optional<double> Quantity::slope(const Candidate&, RreParameter, const Cancellation*) const {
  return std::nullopt;
}

namespace {

/// Returns the RRE request for the directions of a window. Directions are ordered by azimuth and then by incidence.
RreRequest request_of(const AngleWindow& window, const AnalysisSettings& analysis) {
  RreRequest request;
  request.incidence_deg = window.incidence_deg.value_or(std::vector{analysis.incidence_deg});
  request.azimuth_deg = window.azimuth_deg.value_or(std::vector{analysis.azimuth_deg});
  // Rotating the part by an angle is equivalent to rotating the light by the opposite angle.
  for (double& azimuth_deg : request.azimuth_deg) azimuth_deg -= analysis.rotation_deg;
  request.engine = raytrace::engine_name(analysis.engine);
  request.target_error = analysis.target_error;
  request.samples = analysis.rays;
  request.cutoff = analysis.cutoff;
  request.seed = analysis.seed;
  return request;
}

/// Fraction of the incident power, with its standard error.
struct ValueWithError {
  double value = 0.0;
  double std_error = 0.0;
};

/// Returns the weighted mean. All directions use the same random numbers. Therefore their errors are correlated and are
/// added linearly.
ValueWithError mean_of(const std::vector<ValueWithError>& shares, const std::vector<double>& weights) {
  ValueWithError mean;
  double total = 0.0;
  for (std::size_t k = 0; k < shares.size(); ++k) {
    mean.value += weights[k] * shares[k].value;
    mean.std_error += weights[k] * shares[k].std_error;
    total += weights[k];
  }
  if (total > 0.0) return {mean.value / total, mean.std_error / total};
  return {};
}

ValueWithError min_of(const std::vector<ValueWithError>& shares) {
  return *std::min_element(shares.begin(), shares.end(),
                           [](const ValueWithError& a, const ValueWithError& b) { return a.value < b.value; });
}

class FractionQuantity final : public Quantity {
 public:
  FractionQuantity(std::string name, const FractionSpec& spec) : Quantity(std::move(name)), spec_(spec) {}

  std::optional<Measured> measure(const Candidate& candidate, const Cancellation* cancel) const override {
    const RreStudy study({design_of(candidate)}, resolve(request_of(spec_.window, candidate.analysis())));
    const RreResult result = study.run(candidate.progress(), cancel);
    if (!result.complete) return std::nullopt;
    const std::size_t cones = result.designs.front().detector.acceptance_half_angle_deg.size();
    std::vector<ValueWithError> shares;
    std::vector<double> weights;
    for (std::size_t k = 0; k < result.points.size(); k += cones) {
      shares.push_back(fraction_at(&result.points[k], cones));
      const double sine = std::sin(Angle::from_deg(result.points[k].incidence_deg).rad());
      weights.push_back(spec_.window.by_solid_angle ? std::abs(sine) : 1.0);
    }
    const ValueWithError share = spec_.reduction == Reduction::min ? min_of(shares) : mean_of(shares, weights);
    return Measured{share.value, share.std_error};
  }

  std::string tracing() const override { return "rre " + name(); }

  bool is_additive() const override { return spec_.reduction != Reduction::min; }

  std::string label() const override {
    if (spec_.reduction != Reduction::each) return name();
    const auto angle = [](const char* of, const std::optional<std::vector<double>>& deg) {
      return deg ? fmt::format(" {} {:g}", of, deg->front()) : std::string();
    };
    return name() + angle("incidence", spec_.window.incidence_deg) + angle("azimuth", spec_.window.azimuth_deg);
  }

  std::optional<double> slope(const Candidate& candidate, RreParameter parameter,
                              const Cancellation* cancel) const override {
    const bool is_rre = spec_.account == static_cast<std::size_t>(raytrace::Account::retroreflected);
    if (!is_rre || spec_.beyond_half_angle_deg || spec_.reduction == Reduction::min) return std::nullopt;
    if (candidate.design().entrance) return std::nullopt;  // derivatives require a plane entrance face
    RreRequest request = request_of(spec_.window, candidate.analysis());
    if (!raytrace::may_be_exact(candidate.analysis().engine)) return std::nullopt;
    request.engine = raytrace::engine_name(raytrace::Engine::exact);
    request.derivatives = true;
    // Resets those settings of the engine `auto` that the engine `exact` does not accept.
    request.samples.reset();
    if (request.cutoff) request.target_error.reset();
    const RreResult result = RreStudy({design_of(candidate)}, resolve(request)).run(nullptr, cancel);
    if (!result.complete) return std::nullopt;
    std::vector<ValueWithError> slopes;
    std::vector<double> weights;
    for (const RrePoint& point : result.points) {
      const auto found = std::find_if(point.derivatives.begin(), point.derivatives.end(),
                                      [&](const RreDerivative& d) { return d.parameter == parameter; });
      if (found == point.derivatives.end() || found->missing_reason) return std::nullopt;
      slopes.push_back({found->derivative.value, 0.0});
      const double sine = std::sin(Angle::from_deg(point.incidence_deg).rad());
      weights.push_back(spec_.window.by_solid_angle ? std::abs(sine) : 1.0);
    }
    return mean_of(slopes, weights).value;
  }

 private:
  /// Returns the design with the acceptance cones of the quantity, in ascending order.
  design::Design design_of(const Candidate& candidate) const {
    design::Design design = candidate.design();
    std::vector<double>& cones = design.detector.acceptance_half_angle_deg;
    cones = {spec_.acceptance_half_angle_deg.value_or(cones.front())};
    if (spec_.beyond_half_angle_deg) cones.insert(cones.begin(), *spec_.beyond_half_angle_deg);
    return design;
  }

  ValueWithError fraction_at(const RrePoint* points, std::size_t cones) const {
    const RrePoint& widest = points[cones - 1];
    if (cones == 2) return {widest.rre - points[0].rre, widest.std_error + points[0].std_error};
    return {widest.ledger.power[spec_.account], widest.std_error};
  }

  FractionSpec spec_;
};

const geometry::RtpElement& prism_of(const Candidate& candidate) {
  design::require_supported(candidate.design(),
                            {.what = "machining time", .substrates = false, .entrances = true, .wet_backs = true});
  const auto* prism = std::get_if<geometry::RtpElement>(&candidate.design().part().element);
  if (prism == nullptr) throw InputError("machining time can be computed only for prisms (element.kind = \"rtp\")");
  return *prism;
}

double full_element_area_mm2(const geometry::PartSpec& spec) {
  return geometry::area(geometry::aperture_outline(spec.element));
}

std::optional<double> total_reflection_limit_deg(const design::Design& design) {
  if (design.part().substrate) return std::nullopt;  // on a substrate, elements have different orientations
  const auto library = materials::MaterialLibrary::shipped();
  const design::OpticalModel model = design::make_model(design, library);
  double least = model.spectral.front().optics.index;
  for (const design::SpectralOptics& light : model.spectral) least = std::min(least, light.optics.index);
  return design::tir_limit_deg(design.part(), least, model.optics.back_index);
}

/// Returns the plan of a candidate on its machine, or null if the process names no machine.
std::shared_ptr<const MachinePlan> machine_plan_of(const Candidate& candidate) {
  if (candidate.machining().machine.empty()) return nullptr;
  prism_of(candidate);
  return candidate.shared<MachinePlan>("machine plan", [&] {
    return std::make_shared<MachinePlan>(plan_on_machine(candidate.design(), candidate.machining()));
  });
}

/// Returns the machining time of one element in seconds. If the process names a machine, it is the mean over all
/// elements of the plan.
std::optional<double> element_time_s(const Candidate& candidate) {
  const auto plan = machine_plan_of(candidate);
  if (!plan) return seconds_per_element(prism_of(candidate), candidate.machining());
  if (!plan->time_s) return std::nullopt;
  return *plan->time_s / static_cast<double>(plan->elements);
}

/// Returns the machining time in hours. Only whole elements are machined.
std::optional<double> machining_time_h(const Candidate& candidate) {
  constexpr double seconds_per_hour = 3600.0;
  const std::optional<double> time_s = element_time_s(candidate);
  if (!time_s) return std::nullopt;
  const auto plan = machine_plan_of(candidate);
  const double elements =
      plan ? static_cast<double>(plan->elements) : static_cast<double>(candidate.part().elements_full);
  return elements * *time_s / seconds_per_hour;
}

std::optional<double> area_rate_mm2_per_h(const Candidate& candidate) {
  const std::optional<double> time_s = element_time_s(candidate);
  if (!time_s) return std::nullopt;
  return 3600.0 * full_element_area_mm2(candidate.design().part()) / *time_s;
}

/// Returns the width of an element minus the width of the tool. Returns 0 if the process gives no tool width, or if the
/// difference is less than one nanometre.
double tool_fit_mm(const Candidate& candidate) {
  const double width_mm = prism_of(candidate).width_mm;
  const double margin_mm = width_mm - candidate.machining().tool_width_mm.value_or(width_mm);
  return std::abs(margin_mm) < fabrication::kFitToleranceMm ? 0.0 : margin_mm;
}

/// Returns the smallest distance of an axis from its limit. Returns no value if the process names no machine, or if the
/// machine cannot reach a facet.
std::optional<double> machine_travel_mm(const Candidate& candidate) {
  const auto plan = machine_plan_of(candidate);
  return plan ? plan->travel_mm : std::nullopt;
}

/// Returns the tool life minus the path length of the edge in one element. Returns no value without a machine or a tool
/// life.
std::optional<double> edge_life_margin_mm(const Candidate& candidate) {
  const auto plan = machine_plan_of(candidate);
  const std::optional<double>& life_mm = candidate.machining().edge_life_mm;
  if (!plan || !plan->cut_per_element_mm || !life_mm) return std::nullopt;
  return *life_mm - *plan->cut_per_element_mm;
}

/// Returns the design of a candidate, which must be an array of equal elements, flat or on a substrate.
/// \throw InputError if the design has balls, solids or zones
const design::Design& elements_of(const Candidate& candidate, const std::string& name) {
  design::require_supported(candidate.design(), {.what = name, .entrances = true, .wet_backs = true});
  return candidate.design();
}

/// Returns the design of a candidate under the conditions of elements_of(). In addition, the entrance face must be
/// plane.
const design::Design& elements_behind_plane(const Candidate& candidate, const std::string& name) {
  design::require_supported(candidate.design(), {.what = name, .wet_backs = true});
  return candidate.design();
}

/// Returns the distance along z between the lowest point of the back and the highest point of the entrance face.
double lens_thickness_mm(const Candidate& candidate) {
  const geometry::Part& part = candidate.part();
  if (!candidate.design().entrance) return part.element_depth_mm + part.thickness_mm;
  const geometry::Entrance entrance = design::entrance_of_design(candidate.design(), part);
  return part.element_depth_mm + geometry::entrance_range(entrance, part.outline).highest_mm;
}

/// Returns the value of a quantity that needs no ray tracing.
/// \param name name of the quantity, for messages
std::optional<double> plain_value(PlainQuantity which, const Candidate& candidate, const std::string& name) {
  constexpr double um_per_mm = 1e3;
  switch (which) {
    case PlainQuantity::elements_full: return static_cast<double>(candidate.part().elements_full);
    case PlainQuantity::elements_partial: return static_cast<double>(candidate.part().elements_partial);
    case PlainQuantity::element_depth_mm:
      // The depth of a part on a substrate includes the depth of the substrate. Therefore the depth of a single element
      // is computed instead.
      return candidate.design().elements() && candidate.design().part().substrate
                 ? geometry::element_depth_mm(candidate.part().spec.element, candidate.part().spec.angle_errors)
                 : candidate.part().element_depth_mm;
    case PlainQuantity::lens_thickness_mm: return lens_thickness_mm(candidate);
    case PlainQuantity::facet_area_mm2: return candidate.part().retro_facet_area_mm2;
    case PlainQuantity::effective_area_mm2:
      return static_cast<double>(candidate.part().elements_full) *
             geometry::build_part(single_element_of(elements_of(candidate, name)).part()).retro_facet_area_mm2;
    case PlainQuantity::entrance_area_mm2: return candidate.part().entrance_area_mm2;
    case PlainQuantity::full_element_area_fraction:
      return static_cast<double>(candidate.part().elements_full) *
             full_element_area_mm2(elements_of(candidate, name).part()) / candidate.part().entrance_area_mm2;
    case PlainQuantity::tir_limit_deg: return total_reflection_limit_deg(elements_behind_plane(candidate, name));
    case PlainQuantity::tool_fit_mm: return tool_fit_mm(candidate);
    case PlainQuantity::machining_time_h: return machining_time_h(candidate);
    case PlainQuantity::machining_time_per_element_s: return element_time_s(candidate);
    case PlainQuantity::area_rate_mm2_per_h: elements_of(candidate, name); return area_rate_mm2_per_h(candidate);
    case PlainQuantity::process_sa_nm: return process_sa_nm(candidate.machining());
    case PlainQuantity::root_radius_um: return um_per_mm * elements_of(candidate, name).part().edges.root_radius_mm;
    case PlainQuantity::machine_travel_mm: return machine_travel_mm(candidate);
    case PlainQuantity::edge_life_margin_mm: return edge_life_margin_mm(candidate);
  }
  return std::nullopt;
}

class PlainQuantityOf final : public Quantity {
 public:
  PlainQuantityOf(std::string name, PlainQuantity which) : Quantity(std::move(name)), which_(which) {}

  std::optional<Measured> measure(const Candidate& candidate, const Cancellation*) const override {
    return Measured{plain_value(which_, candidate, name()), 0.0};
  }

 private:
  PlainQuantity which_;
};

}  // namespace

std::shared_ptr<const Quantity> make_fraction(std::string name, const FractionSpec& spec) {
  return std::make_shared<FractionQuantity>(std::move(name), spec);
}

std::shared_ptr<const Quantity> make_plain(std::string name, PlainQuantity which) {
  return std::make_shared<PlainQuantityOf>(std::move(name), which);
}

}  // namespace retrace::studies
