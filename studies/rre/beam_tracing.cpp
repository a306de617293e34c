#include "studies/rre/beam_tracing.h"

namespace retrace::studies {

BeamCollector::BeamCollector(const BeamOutputRequest& question, const geometry::Part& part, std::size_t cones,
                             const raytrace::Illumination& illumination) {
  if (question.footprint) footprint_.emplace(part, cones);
  if (question.far_field) far_field_.emplace(illumination);
}

raytrace::BeamObserver BeamCollector::observer() {
  if (!footprint_ && !far_field_) return {};
  return [this](const raytrace::ReturnedBeam& beam) {
    if (footprint_) footprint_->add(beam);
    if (far_field_) far_field_->add(beam);
  };
}

std::optional<Footprint> BeamCollector::footprint() const {
  return footprint_ ? std::optional(footprint_->finish()) : std::nullopt;
}

std::optional<FarField> BeamCollector::far_field() const {
  return far_field_ ? std::optional(far_field_->finish()) : std::nullopt;
}

raytrace::Illumination illumination_of(const RrePoint& at, const design::Design& design) {
  return {Angle::from_deg(at.incidence_deg), Angle::from_deg(at.azimuth_deg), design.light.polarisation};
}

BeamOutputs trace_exact_beams(const raytrace::BeamTracer& tracer, const geometry::Part& part,
                              const raytrace::Optics& optics, const raytrace::Illumination& illumination,
                              const std::vector<double>& cones_deg, const raytrace::BeamPolicy& policy,
                              const BeamOutputRequest& question, const Cancellation* cancel, Progress* progress) {
  BeamCollector collector(question, part, cones_deg.size(), illumination);
  BeamOutputs answer;
  answer.traced = tracer.trace(optics, illumination, cones_deg, policy, cancel, collector.observer(), progress);
  if (!answer.traced.complete) return answer;
  answer.footprint = collector.footprint();
  answer.far_field = collector.far_field();
  return answer;
}

std::vector<RrePoint> points_of(const RrePoint& at, const std::vector<double>& cones_deg,
                                const raytrace::BeamResult& traced) {
  std::vector<RrePoint> points;
  for (std::size_t cone = 0; cone < cones_deg.size(); ++cone) {
    RrePoint point = at;
    point.acceptance_half_angle_deg = cones_deg[cone];
    point.ledger = traced.ledgers[cone];
    point.rre = point.ledger[raytrace::Account::retroreflected];
    point.stokes = traced.stokes[cone];
    point.beams = traced.beams;
    point.depth = traced.depth;
    points.push_back(point);
  }
  return points;
}

std::vector<RrePoint> points_of(const RrePoint& at, const raytrace::MonteCarloResult& traced) {
  std::vector<RrePoint> points;
  for (const raytrace::ConeResult& cone : traced.cones) {
    RrePoint point = at;
    point.acceptance_half_angle_deg = cone.half_angle_deg;
    point.rre = cone.rre;
    point.std_error = cone.std_error;
    point.stokes = cone.stokes;
    point.ledger = cone.ledger;
    points.push_back(point);
  }
  return points;
}

}  // namespace retrace::studies
