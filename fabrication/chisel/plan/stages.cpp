#include "fabrication/chisel/plan/stages.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "fabrication/chisel/plan/chiseling.h"
#include "fabrication/chisel/plan/order.h"
#include "fabrication/chisel/plan/routines.h"
#include "fabrication/job/substrate_cells.h"

namespace retrace::fabrication {
namespace {

class StageMaker {
 public:
  StageMaker(const Job& job, const Machine& machine, Plan& plan) : job_(job), machine_(machine), plan_(plan) {
    find_groups();
  }

  std::vector<RoutineStart> run() {
    if (!cuts_prisms(job_)) {
      chisel();
      return std::move(starts_);
    }
    const int facets = job_.strategy == Strategy::unidirectional ? 1 : 2;
    for (int facet = 1; facet <= facets; ++facet)
      for (const auto& [group, stance] : groups_) {
        plan_.poses.push_back(cutting_pose(job_, machine_, {group.first, facet}, previous_c_deg_, stance));
        previous_c_deg_ = plan_.poses.back().rounded.c_deg;
      }
    switch (job_.strategy) {
      case Strategy::unidirectional:
        for (std::size_t pose = 0; pose < plan_.poses.size(); ++pose) add_roughing(pose);
        break;
      case Strategy::bidirectional:
        add_plunges("layer", plan_.cuts_per_facet, job_.process.roughing_feed_mm_per_min, false);
        break;
      case Strategy::two_step:
        add_plunges("finishing", job_.process.finishing_cuts, job_.process.finishing_feed_mm_per_min, true);
        break;
      case Strategy::dmc: break;
    }
    return std::move(starts_);
  }

 private:
  /// Groups the elements by orientation. Elements that are not rotated come first.
  void find_groups() {
    const double start_mm = job_.substrate ? stock_mm(job_, plan_.elements, job_.process.clearance_mm) : 0.0;
    for (std::size_t k = 0; k < plan_.elements.size(); ++k) {
      const CutElement& element = plan_.elements[k];
      ElementPose stance;
      stance.orientation = element.orientation;
      stance.workpiece_from_element = element.workpiece_from_element;
      stance.zone = element.zone;
      stance.stock_mm = plan_.stock_mm;
      stance.start_mm = start_mm;
      if (job_.substrate) stance.element = static_cast<std::int64_t>(k);
      groups_.try_emplace({element.rotated, element.orientation}, stance);
      has_tilts_ = has_tilts_ || (job_.substrate && element.orientation > 0);
    }
  }

  /// Adds the stages of diamond micro chiseling. In each layer, the first facet of all elements is cut, then the second
  /// and the third one. The chip of a layer separates with the cut of the third facet.
  void chisel() {
    if (!job_.zones.empty())
      add_poses_by_turn();
    else
      has_tilts_ ? add_poses_by_facet() : add_poses_by_group();
    const Process& process = job_.process;
    add_layers("layer", plan_.cuts_per_facet, process.roughing_feed_mm_per_min);
    add_layers("finishing", process.finishing_cuts, process.finishing_feed_mm_per_min);
  }

  /// Returns the thickness of the material that a layer or a finishing cut leaves on the facets.
  double left_mm(std::string_view what, int cut, int cuts, std::size_t zone = 0) const {
    if (what == "finishing") return 1e-3 * job_.process.finishing_depth_um * (cuts - cut);
    const bool is_dmc = !cuts_prisms(job_);
    const double across_mm =
        is_dmc ? chiseling_across_mm(job_, zone, plan_.stock_mm) : roughing_across_mm(job_, plan_.stock_mm);
    // The second plunge of the first layer has the thinnest chip. The chip is the part of the triangular cross-section
    // that remains above the rake face of the first plunge.
    double share = 1.0;
    if (!is_dmc) {
      const double apex_rad = plan_.poses.front().section.apex.rad();
      const double rake_slope =
          std::tan(apex_rad - Angle::from_deg(job_.tool.clearance_deg + job_.tool.wedge_deg).rad());
      const double face_slope = 1.0 / std::tan(0.5 * apex_rad);
      share = std::min(1.0, 2.0 * rake_slope * face_slope / (std::sin(apex_rad) * (rake_slope + face_slope)));
    }
    double dip_mm = 0.0;
    for (const CuttingPose& pose : plan_.poses) dip_mm = std::max(dip_mm, edge_dip_mm(pose.section));
    return (is_dmc ? chiseling_allowance_mm(job_) : 0.0) +
           roughing_remainder_mm(job_, across_mm, cut, cuts, share, dip_mm);
  }

  CuttingPose next_pose(const ElementGroup& group, int facet) {
    const ElementPose& stance = groups_.at(group);
    CuttingPose pose = chiseling_pose(job_, machine_, {group.first, facet, stance.zone}, previous_c_deg_, stance);
    previous_c_deg_ = pose.rounded.c_deg;
    return pose;
  }

  void add_poses_by_group() {
    for (const auto& [group, stance] : groups_) {
      const std::size_t first = plan_.poses.size();
      for (int facet = 1; facet <= 3; ++facet) plan_.poses.push_back(next_pose(group, facet));
      check_v_in_poses(job_, machine_, {plan_.poses[first], plan_.poses[first + 1], plan_.poses[first + 2]}, stance);
    }
  }

  /// Adds the poses facet by facet. With this order, C rotates only a little between elements with different tilts, and
  /// by 120 degrees between facets.
  void add_poses_by_facet() {
    for (int facet = 1; facet <= 3; ++facet)
      for (const auto& [group, stance] : groups_) plan_.poses.push_back(next_pose(group, facet));
    std::size_t k = 0;
    const std::size_t count = groups_.size();
    for (const auto& [group, stance] : groups_) {
      check_v_in_poses(job_, machine_, {plan_.poses[k], plan_.poses[k + count], plan_.poses[k + 2 * count]}, stance);
      ++k;
    }
  }

  /// Adds the poses sorted by their angle C, beginning after the widest gap between two angles. C then rotates in one
  /// direction only. The facets of each element are cut in the same cyclic order in every layer. Any other order would
  /// give thicker chips at dihedral edges.
  void add_poses_by_turn() {
    std::vector<CuttingPose> poses;
    for (const auto& [group, stance] : groups_) {
      std::array<CuttingPose, 3> of_group;
      for (int facet = 1; facet <= 3; ++facet) of_group[static_cast<std::size_t>(facet) - 1] = next_pose(group, facet);
      check_v_in_poses(job_, machine_, of_group, stance);
      poses.insert(poses.end(), of_group.begin(), of_group.end());
    }
    const double sense = machine_.c.sign.value;
    const auto turn_deg = [&](const CuttingPose& pose) {
      const double c_deg = -sense * pose.rounded.c_deg;
      return c_deg - 360.0 * std::floor(c_deg / 360.0);
    };
    std::stable_sort(poses.begin(), poses.end(),
                     [&](const CuttingPose& a, const CuttingPose& b) { return turn_deg(a) < turn_deg(b); });
    std::size_t first = 0;
    double widest_deg = turn_deg(poses.front()) + 360.0 - turn_deg(poses.back());
    constexpr double kSameDeg = 1e-6;
    for (std::size_t k = 1; k < poses.size(); ++k)
      if (const double gap_deg = turn_deg(poses[k]) - turn_deg(poses[k - 1]); gap_deg > widest_deg + kSameDeg) {
        widest_deg = gap_deg;
        first = k;
      }
    std::rotate(poses.begin(), poses.begin() + static_cast<std::ptrdiff_t>(first), poses.end());
    // Add full turns to all angles so that C stays within its limits and as close to 0 as possible.
    const double begin_deg = poses.front().rounded.c_deg;
    const double span_deg = -sense * (360.0 - widest_deg);
    double farthest_deg = std::numeric_limits<double>::infinity();
    previous_c_deg_ = 0.0;
    for (const double turns : {0.0, 1.0, -1.0, 2.0, -2.0}) {
      const double from_deg = begin_deg + 360.0 * turns;
      const double to_deg = from_deg + span_deg;
      const Interval& limits = machine_.c.limits_deg.value;
      const double far_deg = std::max(std::abs(from_deg), std::abs(to_deg));
      if (!limits.contains(from_deg) || !limits.contains(to_deg) || far_deg >= farthest_deg - kSameDeg) continue;
      farthest_deg = far_deg;
      previous_c_deg_ = from_deg;
    }
    for (const CuttingPose& pose : poses)
      plan_.poses.push_back(next_pose({pose.facet.rotated, pose.orientation}, pose.facet.facet));
  }

  /// Adds the layers of all poses. A zone that needs fewer layers starts later, so that all zones finish with the same
  /// layer.
  void add_layers(std::string_view what, int cuts, double feed_mm_per_min) {
    for (int cut = 1; cut <= cuts; ++cut)
      for (std::size_t pose = 0; pose < plan_.poses.size(); ++pose) {
        const bool is_one_of_many = what == "layer" && !job_.zones.empty();
        const int own_cuts =
            is_one_of_many ? chiseling_layers(job_, plan_.poses[pose].facet.zone, plan_.stock_mm) : cuts;
        if (cut > cuts - own_cuts) add_layer(what, cut - (cuts - own_cuts), own_cuts, pose, feed_mm_per_min);
      }
  }

  void add_layer(std::string_view what, int cut, int cuts, std::size_t pose, double feed_mm_per_min) {
    Stage stage;
    stage.name = fmt::format("{}-{}-facet-{}{}", what, cut, plan_.poses[pose].facet.facet, group_name(pose));
    stage.roughs = what == "layer";
    stage.cut = cut;
    stage.cuts = cuts;
    stage.remaining_mm = left_mm(what, cut, cuts, plan_.poses[pose].facet.zone);
    Routine routine = chiseling_routine(job_, machine_, plan_.poses[pose], stage.remaining_mm, feed_mm_per_min);
    routine.subroutine.title = fmt::format("{}: down one edge, up the other", stage.name);
    add(std::move(stage), pose, std::move(routine));
  }

  /// Returns the suffix of the stage names of a pose. It identifies the elements by rotation, tilt and zone.
  std::string group_name(std::size_t pose) const {
    std::string name = plan_.poses[pose].facet.rotated ? "-turned" : "";
    if (has_tilts_) name += fmt::format("-tilt-{}", plan_.poses[pose].orientation + 1);
    if (!job_.zones.empty()) name += fmt::format("-zone-{}", plan_.poses[pose].facet.zone + 1);
    return name;
  }

  void add_roughing(std::size_t pose) {
    Stage stage;
    stage.name = "roughing" + group_name(pose);
    stage.roughs = true;
    stage.remaining_mm = finishing_allowance_mm(job_);
    Routine routine = unidirectional_routine(job_, plan_.poses[pose].section);
    routine.subroutine.title = fmt::format("{}: {} cuts by plunging and ploughing", stage.name, plan_.cuts_per_facet);
    add(std::move(stage), pose, std::move(routine));
  }

  /// Adds the stages of plunging. Each cut is made in all poses before the next cut begins.
  /// \param rough_first true: adds the roughing stage before the first cut of facet 1
  void add_plunges(std::string_view what, int cuts, double feed_mm_per_min, bool rough_first) {
    for (int cut = 1; cut <= cuts; ++cut)
      for (std::size_t pose = 0; pose < plan_.poses.size(); ++pose) {
        const FacetChoice& facet = plan_.poses[pose].facet;
        if (rough_first && cut == 1 && facet.facet == 1) add_roughing(pose);
        Stage stage;
        stage.name = fmt::format("{}-{}-facet-{}{}", what, cut, facet.facet, group_name(pose));
        stage.cut = cut;
        stage.cuts = cuts;
        stage.remaining_mm = left_mm(what, cut, cuts);
        Routine routine = plunge_routine(job_, plan_.poses[pose].section, stage.remaining_mm, feed_mm_per_min);
        routine.subroutine.title = fmt::format("{}: one plunge", stage.name);
        add(std::move(stage), pose, std::move(routine));
      }
  }

  void add(Stage stage, std::size_t pose, Routine routine) {
    stage.pose = pose;
    stage.subroutine = static_cast<std::uint32_t>(plan_.subroutines.size());
    routine.subroutine.number = kFirstSubroutine + static_cast<int>(plan_.subroutines.size());
    starts_.push_back({routine.start, extent_of(routine.subroutine)});
    plan_.subroutines.push_back(std::move(routine.subroutine));
    plan_.stages.push_back(std::move(stage));
  }

  const Job& job_;
  const Machine& machine_;
  Plan& plan_;
  std::map<ElementGroup, ElementPose> groups_;
  bool has_tilts_ = false;
  std::vector<RoutineStart> starts_;
  double previous_c_deg_ = 0.0;
};

}  // namespace

std::vector<RoutineStart> add_stages(const Job& job, const Machine& machine, Plan& plan) {
  return StageMaker(job, machine, plan).run();
}

}  // namespace retrace::fabrication
