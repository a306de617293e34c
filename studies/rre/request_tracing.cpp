#include "studies/rre/request_tracing.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <tuple>
#include <utility>

#include "design/light_symmetry.h"
#include "design/total_reflection.h"
#include "raytrace/light/light_setup.h"
#include "studies/rre/adaptive_curve.h"
#include "studies/rre/equivalent_directions.h"
#include "studies/rre/spectral_mean.h"

namespace retrace::studies {
namespace {

/// \param incidence_deg angles of incidence of each design
std::vector<Direction> directions_of(const std::vector<design::OpticalModel>& models, const RreSettings& request,
                                     const std::vector<std::vector<double>>& incidence_deg) {
  std::vector<Direction> directions;
  for (std::size_t d = 0; d < models.size(); ++d)
    for (const double azimuth : request.azimuth_deg)
      for (const double incidence : incidence_deg[d]) {
        RrePoint at;
        at.design = d;
        at.incidence_deg = incidence;
        at.azimuth_deg = azimuth;
        at.wavelength_nm = models[d].wavelength_nm;
        Direction direction;
        direction.at = at;
        const std::size_t wavelengths = models[d].spectral.size();
        direction.spectral.resize(wavelengths);
        direction.rays.resize(wavelengths);
        direction.missed_target.resize(wavelengths);
        directions.push_back(std::move(direction));
      }
  return directions;
}

/// Computes the points of a direction if all its wavelengths have been traced.
void finish(Direction& direction, const design::Design& design, const design::OpticalModel& model) {
  const auto& spectral = direction.spectral;
  if (std::any_of(spectral.begin(), spectral.end(), [](const auto& cones) { return cones.empty(); })) return;
  if (!design.light.spectrum()) {
    direction.points = spectral.front();
    return;
  }
  for (std::size_t cone = 0; cone < spectral.front().size(); ++cone) {
    RrePoint at = direction.at;
    at.acceptance_half_angle_deg = spectral.front()[cone].acceptance_half_angle_deg;
    std::vector<SpectralPoint> points;
    for (std::size_t w = 0; w < spectral.size(); ++w) points.push_back({model.spectral[w].weight, spectral[w][cone]});
    direction.points.push_back(spectral_mean(at, points));
    direction.points.back().derivatives = spectral.front()[cone].derivatives;
  }
}

/// Returns the known kinks of RRE of a design as a function of incidence. Kinks are angles at which total reflection
/// begins or ends, at any of the requested azimuths and wavelengths. Another kink is at half of an acceptance angle.
/// There, the light that the entrance face reflects leaves the acceptance cone, because the reflected light rotates
/// twice as fast as the part.
std::vector<double> kinks_of(const design::Design& design, const design::OpticalModel& model,
                             const RreSettings& request) {
  std::vector<double> kinks;
  if (design.balls() || design.entrance || design.has_deflecting_shells()) return kinks;
  for (const double cone_deg : design.detector.acceptance_half_angle_deg)
    kinks.insert(kinks.end(), {-0.5 * cone_deg, 0.5 * cone_deg});
  if (!design.elements() || design.part().substrate || !design.needs_total_reflection()) return kinks;
  for (const double azimuth : request.azimuth_deg)
    for (const design::SpectralOptics& light : model.spectral) {
      const auto add = [&](const raytrace::Optics& optics) {
        const std::vector<double> edges = design::total_reflection_edges_deg(
            design.part(), optics.index, optics.back_index, Angle::from_deg(azimuth));
        kinks.insert(kinks.end(), edges.begin(), edges.end());
      };
      add(light.optics);
      if (light.optics.wet) add(light.optics.wet->optics);
    }
  return kinks;
}

/// Reports the progress of an unknown number of rounds. Each round is assumed to be half of the remaining work.
class RoundProgress : public Progress {
 public:
  explicit RoundProgress(Progress* whole) : whole_(whole) {}
  void finish_round() { begin_ = 0.5 * (begin_ + 1.0); }
  void at(double share) override {
    if (whole_ != nullptr) whole_->at(begin_ + 0.5 * (1.0 - begin_) * share);
  }

 private:
  Progress* whole_;
  double begin_ = 0.0;
};

/// Traces directions and computes their points.
void trace_points(const std::vector<design::Design>& designs, const std::vector<design::OpticalModel>& models,
                  DirectionTracing& tracing, std::vector<Direction>& directions, Progress* progress) {
  tracing.trace(directions, progress);
  for (Direction& direction : directions) finish(direction, designs[direction.at.design], models[direction.at.design]);
}

bool all_are_traced(const std::vector<Direction>& directions) {
  return std::none_of(directions.begin(), directions.end(), [](const Direction& at) { return at.points.empty(); });
}

/// Adds values to the curves of their designs.
void add_values(const std::vector<Direction>& directions, std::vector<AdaptiveCurve>& curves) {
  for (const Direction& direction : directions)
    for (const RrePoint& point : direction.points)
      curves[point.design].add(point.incidence_deg, {point.rre, point.std_error});
}

/// Returns the next angles of incidence of each design.
std::vector<std::vector<double>> next_incidences(std::vector<AdaptiveCurve>& curves) {
  std::vector<std::vector<double>> incidences;
  incidences.reserve(curves.size());
  for (AdaptiveCurve& curve : curves) incidences.push_back(curve.next());
  return incidences;
}

bool are_empty(const std::vector<std::vector<double>>& lists) {
  return std::all_of(lists.begin(), lists.end(), [](const std::vector<double>& list) { return list.empty(); });
}

/// Sorts directions by design, azimuth in the order of the request, and ascending incidence.
void put_in_order(std::vector<Direction>& directions, const std::vector<double>& azimuth_deg) {
  const auto sort_key = [&](const Direction& direction) {
    const RrePoint& at = direction.at;
    const auto azimuth = std::find(azimuth_deg.begin(), azimuth_deg.end(), at.azimuth_deg);
    return std::tuple(at.design, azimuth - azimuth_deg.begin(), at.incidence_deg);
  };
  std::sort(directions.begin(), directions.end(),
            [&](const Direction& a, const Direction& b) { return sort_key(a) < sort_key(b); });
}

/// Returns a text about each design whose curve is not resolved.
std::vector<std::string> unresolved(const std::vector<design::Design>& designs,
                                    const std::vector<AdaptiveCurve>& curves) {
  std::vector<std::string> texts;
  for (std::size_t d = 0; d < curves.size(); ++d)
    if (curves[d].residual_error() > 0.0)
      texts.push_back(
          fmt::format("{}: {} angles of incidence in each range do not resolve the curve: linear interpolation between "
                      "them may deviate from RRE by {:.2g}",
                      designs[d].source_name(), AdaptiveCurve::kMaxPoints, curves[d].residual_error()));
  return texts;
}

/// Traces incidences that are chosen automatically, for each design on its own. The azimuths of a design have the same
/// incidences.
TracedRequest trace_chosen(const std::vector<design::Design>& designs, const std::vector<design::OpticalModel>& models,
                           const RreSettings& request, Progress* progress, const Cancellation* cancel) {
  TracedRequest traced;
  DirectionTracing tracing(designs, models, request, cancel);
  RoundProgress part(progress);
  std::vector<AdaptiveCurve> curves;
  for (std::size_t d = 0; d < designs.size(); ++d)
    curves.emplace_back(request.incidence_spans, kinks_of(designs[d], models[d], request), request.incidence_deg,
                        std::max(kCurveTolerance, target_error_of(request)));
  auto incidences = next_incidences(curves);
  while (traced.complete && !are_empty(incidences)) {
    std::vector<Direction> round = directions_of(models, request, incidences);
    trace_points(designs, models, tracing, round, &part);
    part.finish_round();
    traced.complete = all_are_traced(round);
    if (traced.complete) {
      add_values(round, curves);
      incidences = next_incidences(curves);
      traced.complete = are_empty(incidences) || !is_cancelled(cancel);
    }
    std::move(round.begin(), round.end(), std::back_inserter(traced.directions));
  }
  traced.traced_directions = traced.directions.size();
  put_in_order(traced.directions, request.azimuth_deg);
  traced.warnings = unresolved(designs, curves);
  return traced;
}

geometry::Vec3 to_source(const Direction& direction) {
  return raytrace::direction_to_source(
      {Angle::from_deg(direction.at.incidence_deg), Angle::from_deg(direction.at.azimuth_deg), {}});
}

/// Returns Stokes parameters that a symmetry maps from one direction to another. Both are relative to source_axis().
/// \param to_traced maps the direction `at` to the direction of the given light
raytrace::Stokes mapped(raytrace::Stokes stokes, const SharedDirection& to_traced, const geometry::Vec3& at) {
  // A reflection reverses the sense of rotation about the direction.
  if (to_traced.to_traced.determinant() < 0.0) {
    stokes.u = -stokes.u;
    stokes.v = -stokes.v;
  }
  const SharedDirection back{0, to_traced.to_traced.transpose()};
  return raytrace::in_source_axes({stokes, back.mapped(raytrace::source_axis(to_traced.mapped(at)))}, at);
}

/// Sets the results of a direction to those of an equivalent direction that was traced.
/// \param is_shared see Direction::is_shared; false if `direction` is the traced direction itself
void set_results(const Direction& traced, const SharedDirection& shared, bool is_shared, Direction& direction) {
  const RrePoint at = direction.at;
  direction = traced;
  direction.at = at;
  direction.is_shared = is_shared;
  for (RrePoint& point : direction.points) {
    point.incidence_deg = at.incidence_deg;
    point.azimuth_deg = at.azimuth_deg;
    point.stokes = mapped(point.stokes, shared, to_source(direction));
  }
}

/// Returns the directions of all designs, in groups that share one trace.
/// \param directions directions, sorted by design
std::vector<EquivalentDirections> group_directions(const std::vector<Direction>& directions,
                                                   const std::vector<design::Design>& designs,
                                                   const std::vector<design::OpticalModel>& models) {
  std::vector<EquivalentDirections> groups;
  for (std::size_t first = 0, last = 0; first < directions.size(); first = last) {
    const std::size_t design = directions[first].at.design;
    std::vector<geometry::Vec3> to_sources;
    for (; last < directions.size() && directions[last].at.design == design; ++last)
      to_sources.push_back(to_source(directions[last]));
    for (EquivalentDirections& group :
         group_equivalent_directions(to_sources, design::light_symmetries(designs[design], models[design]))) {
      for (SharedDirection& shared : group) shared.index += first;
      groups.push_back(std::move(group));
    }
  }
  return groups;
}

/// Traces the grid of a polar map. Of equivalent directions, only one is traced.
TracedRequest trace_grid(const std::vector<design::Design>& designs, const std::vector<design::OpticalModel>& models,
                         const RreSettings& request, std::vector<Direction> directions, Progress* progress,
                         const Cancellation* cancel) {
  const std::vector<EquivalentDirections> groups = group_directions(directions, designs, models);
  std::vector<Direction> representatives;
  for (const EquivalentDirections& group : groups) representatives.push_back(directions[group.front().index]);
  TracedRequest traced;
  DirectionTracing tracing(designs, models, request, cancel);
  trace_points(designs, models, tracing, representatives, progress);
  traced.complete = all_are_traced(representatives);
  for (std::size_t k = 0; k < groups.size(); ++k)
    for (const SharedDirection& shared : groups[k])
      set_results(representatives[k], shared, &shared != &groups[k].front(), directions[shared.index]);
  traced.directions = std::move(directions);
  traced.traced_directions = representatives.size();
  return traced;
}

}  // namespace

TracedRequest trace_request(const std::vector<design::Design>& designs, const std::vector<design::OpticalModel>& models,
                            const RreSettings& request, std::optional<std::size_t> only, Progress* progress,
                            const Cancellation* cancel) {
  if (!request.incidence_spans.empty()) return trace_chosen(designs, models, request, progress, cancel);
  TracedRequest traced;
  traced.directions = directions_of(models, request, std::vector(models.size(), request.incidence_deg));
  if (only) std::erase_if(traced.directions, [&](const Direction& direction) { return direction.at.design != *only; });
  if (request.map) return trace_grid(designs, models, request, std::move(traced.directions), progress, cancel);
  DirectionTracing tracing(designs, models, request, cancel);
  traced.traced_directions = traced.directions.size();
  trace_points(designs, models, tracing, traced.directions, progress);
  traced.complete = all_are_traced(traced.directions);
  return traced;
}

}  // namespace retrace::studies
