#include "fabrication/chisel/plan/edge_cuts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace retrace::fabrication {
namespace {

using geometry::Vec3;

/// Returns the intersection of the planes of the two facets, relative to the tool reference point, while the tool is at
/// the root. In the section of the tool, both planes are tangents of the edge circle (the rounded edge). The tool
/// reference point is the intersection of the vertical and the horizontal tangent of this circle
/// (docs/theory/verification.md).
Vec3 tip_of(const Job& job, const Section& section) {
  if (!cuts_prisms(job)) return Vec3::Zero();
  return -Vec3::UnitZ() * section.edge_mm / std::sin(section.apex.rad());
}

Angle edge_rise(const Job& job) {
  return Angle::from_deg(cuts_prisms(job) ? 0.0 : 90.0 - 0.5 * job.tool.nose_angle_deg);
}

/// Collects the cuts of all visits. A visit is one call of a subroutine at an element.
class Collector {
 public:
  Collector(const Job& job, const Plan& plan, const std::vector<std::size_t>& elements)
      : job_(job), plan_(plan), elements_(elements) {
    for (std::size_t k = 0; k < plan.stages.size(); ++k)
      stages_.emplace(plan.subroutines[plan.stages[k].subroutine].title, k);
  }

  void add(const Program& program) {
    for (const Item& item : program.items) {
      const auto* const visit = std::get_if<CycleCall>(&item);
      if (visit != nullptr && is_wanted(visit->element)) add(program.subroutines[visit->subroutine], *visit);
    }
  }

  std::vector<FacetEdgeCut> take() { return std::move(cuts_); }

 private:
  bool is_wanted(std::int32_t element) const {
    return elements_.empty() ||
           std::binary_search(elements_.begin(), elements_.end(), static_cast<std::size_t>(element));
  }

  void add(const Subroutine& routine, const CycleCall& visit) {
    const std::size_t stage = stages_.at(routine.title);
    const CuttingPose& pose = plan_.poses[plan_.stages[stage].pose];
    // The last plunge produces the plunged facet, and the plough after it produces the other facet. If the plough is
    // divided into two moves, only its first move is along the facet. A V-shaped tool makes one cut down and one cut
    // up.
    std::array<std::optional<FacetEdgeCut>, 2> last;
    LinearPosition at = visit.start;
    for (const Step& step : routine.steps) {
      const auto* const move = std::get_if<Move>(&step);
      if (move == nullptr) continue;
      const LinearPosition by(move->to[kX].value_or(0), move->to[kY].value_or(0), move->to[kZ].value_or(0));
      at += by;
      const bool is_way_up = !cuts_prisms(job_) && move->motion == Motion::retract;
      if (move->motion != Motion::plunge && move->motion != Motion::plough && !is_way_up) continue;
      const bool ploughs = move->motion == Motion::plough;
      if (move->motion == Motion::plunge) last[1].reset();
      if (ploughs && last[1]) continue;
      FacetEdgeCut cut = cut_of(visit, stage, pose, ploughs, at, by);
      cut.ends_at_root = move->motion == Motion::plunge;
      last[ploughs || is_way_up ? 1 : 0] = std::move(cut);
    }
    for (const auto& cut : last)
      if (cut) cuts_.push_back(*cut);
  }

  FacetEdgeCut cut_of(const CycleCall& visit, std::size_t stage, const CuttingPose& pose, bool ploughs,
                      const LinearPosition& at, const LinearPosition& by) const {
    FacetEdgeCut cut;
    cut.element = static_cast<std::size_t>(visit.element);
    cut.facet = static_cast<std::size_t>(ploughs ? 3 - pose.facet.facet : pose.facet.facet) - 1;
    cut.stage = stage;
    cut.is_ploughed = ploughs;
    const Vec3 words = millimetres(at);
    const bool tilts_head = !cuts_prisms(job_);
    cut.cut.at = {words.x(),          words.y(),
                  words.z(),          tilts_head ? 0.0 : pose.rounded.a_deg,
                  pose.rounded.c_deg, tilts_head ? pose.rounded.a_deg : 0.0};
    cut.cut.travel_mm = millimetres(by);
    cut.cut.tip_mm = tip_of(job_, pose.section);
    cut.cut.edge_rise = edge_rise(job_);
    return cut;
  }

  const Job& job_;
  const Plan& plan_;
  const std::vector<std::size_t>& elements_;
  /// Index of each stage. The key is the title of the stage's subroutine, because the numbers of subroutines differ
  /// between programs.
  std::map<std::string, std::size_t> stages_;
  std::vector<FacetEdgeCut> cuts_;
};

}  // namespace

std::vector<FacetEdgeCut> facet_edge_cuts(const Job& job, const Plan& plan, const std::vector<std::size_t>& elements) {
  Collector collector(job, plan, elements);
  for (const Program& program : plan.programs) collector.add(program);
  return collector.take();
}

}  // namespace retrace::fabrication
