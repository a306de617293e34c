#include "fabrication/chisel/plan/routines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/number_format.h"
#include "fabrication/chisel/plan/process_facts.h"
#include "fabrication/job/tool_limits.h"

namespace retrace::fabrication {
namespace {

using geometry::Vec2;

/// Tolerance for a number of cuts or passes that exceeds a whole number due to rounding errors.
constexpr double kWholeTolerance = 1e-9;
/// Maximum number of cuts per facet. A larger number indicates that the depth of cut is given in a wrong unit.
constexpr int kMaxCuts = 100'000;

/// Builds the moves of a subroutine from points of the section, rounded to whole increments.
class SectionPath {
 public:
  SectionPath(Routine& routine, const Vec2& start_mm, Nanometres step_nm)
      : routine_(routine), step_nm_(step_nm), at_(place_of(start_mm)) {
    routine.start = at_;
  }

  void to(const Vec2& point_mm, Motion motion, double feed_mm_per_min) {
    const LinearPosition to = place_of(point_mm);
    if (to == at_) return;
    routine_.subroutine.steps.push_back(increment(motion, to - at_, feed_mm_per_min));
    at_ = to;
  }

  void dwell(double seconds) {
    const auto ms = static_cast<std::int32_t>(std::lround(1e3 * seconds));
    if (ms > 0) routine_.subroutine.steps.push_back(Dwell{ms});
  }

 private:
  LinearPosition place_of(const Vec2& point_mm) const {
    return {0, to_step(point_mm.x() * kNanometresPerMm, step_nm_), to_step(point_mm.y() * kNanometresPerMm, step_nm_)};
  }

  Routine& routine_;
  Nanometres step_nm_ = 1;
  LinearPosition at_;
};

Vec2 start_of_cut(const Section& section, double y, double clearance_mm) {
  return {y, section.face_z(y, clearance_mm)};
}

/// Returns the intersection of a line from `point` with the clearance plane above the blank's face.
Vec2 on_clearance_plane(const Section& section, const Vec2& point, const Vec2& direction, double clearance_mm) {
  const double to_go = section.depth_mm + section.start_mm + clearance_mm - section.face_normal.dot(point);
  return point + to_go / section.face_normal.dot(direction) * direction;
}

/// Returns the maximum chip thickness of the first slice, divided by the width of the slice at the floor. The thickness
/// is measured along the wall's normal. The chip of the first slice is bounded by the rake face and the blank's face.
double first_slice_thickness_ratio(const Section& section) {
  const double rake_slope = std::tan(section.rake.rad());
  const double face_slope = 1.0 / std::tan(0.5 * section.apex.rad());
  return rake_slope * face_slope / (rake_slope + face_slope) / std::sin(section.apex.rad());
}

/// Returns the total thickness, along the wall's normal, of all slices of a unidirectional subroutine. The slices fill
/// the element up to the blank's face. Heights are measured from the intersection of the edge circle's tangents, which
/// is below the tool reference point.
double slices_across_mm(const Section& section, double left_mm) {
  const auto over_floor_mm = [&](double y) {
    const double tip_z = section.floor_z(y, left_mm) - section.edge_mm / section.floor_normal.y();
    return section.face_z(y, section.stock_mm - section.start_mm) - tip_z;
  };
  return over_floor_mm(0.0) / (over_floor_mm(0.0) - over_floor_mm(section.wall_y)) - left_mm;
}

/// Adds a plough from the root along the floor. It is one move, or two moves if the tool lifts off the floor after the
/// chip has separated.
Vec2 plough(SectionPath& path, const Job& job, const Section& section, const Vec2& root) {
  const Process& process = job.process;
  const double freed_mm = shortest_plough_mm(job, section);
  const double length_mm = process.shortest_plough ? freed_mm : std::max(process.plough_length_mm, freed_mm);
  Vec2 end = root + length_mm * section.floor_direction;
  if (process.plough_lift_um > 0.0 && length_mm > freed_mm) {
    path.to(root + freed_mm * section.floor_direction, Motion::plough, process.roughing_feed_mm_per_min);
    end += Vec2(0.0, 1e-3 * process.plough_lift_um);
  }
  path.to(end, Motion::plough, process.roughing_feed_mm_per_min);
  return end;
}

}  // namespace

double finishing_allowance_mm(const Job& job) {
  return job.strategy == Strategy::two_step ? 1e-3 * job.process.finishing_cuts * job.process.finishing_depth_um : 0.0;
}

double roughing_across_mm(const Job& job, double stock_mm) {
  const geometry::RtpElement element = blank_prism(job);
  const double apex_rad = Angle::from_deg(element.apex_angle_deg).rad();
  const double facet_mm = 0.5 * element.base_mm / std::sin(0.5 * apex_rad) + stock_mm / std::cos(0.5 * apex_rad);
  const double across_mm = facet_mm * std::sin(apex_rad) - finishing_allowance_mm(job);
  check_allowance(job, across_mm);
  return job.strategy == Strategy::bidirectional ? 0.5 * across_mm : across_mm;
}

int cuts_per_facet(const Job& job, double stock_mm) {
  return whole_cuts(job, roughing_across_mm(job, stock_mm) / (1e-3 * job.process.roughing_depth_um));
}

double roughing_remainder_mm(const Job& job, double across_mm, int cut, int cuts, double thickness_ratio,
                             double dip_mm) {
  const double depth_mm = 1e-3 * job.process.roughing_depth_um;
  const double least_mm = 1e-3 * job.process.min_chip_um.value_or(0.0);
  const double left_mm = depth_mm * (cuts - cut);
  const double taken_mm = across_mm - left_mm;
  // A cut above the blank's face removes nothing, so the minimum chip thickness does not apply to this cut.
  if (least_mm == 0.0 || taken_mm <= -dip_mm || thickness_ratio * taken_mm - dip_mm >= least_mm) return left_mm;
  const double shared_mm = cut < cuts ? 0.5 * (taken_mm + depth_mm) : taken_mm;
  if (thickness_ratio * shared_mm - dip_mm < least_mm)
    throw InputError(
        job.where("process.min_chip_um"),
        fmt::format("must be at most {} um, the chip thickness of the first roughing cut, got {}",
                    fixed(1e3 * (thickness_ratio * shared_mm - dip_mm), 3), shortest(*job.process.min_chip_um)));
  return across_mm - shared_mm;
}

void check_allowance(const Job& job, double left_mm) {
  if (left_mm > 0.0) return;
  throw InputError(
      job.where("process.finishing_depth_um"),
      fmt::format("must leave material for roughing: {} finishing cuts of {} um exceed the depth of a facet by {} um",
                  job.process.finishing_cuts, shortest(job.process.finishing_depth_um), fixed(-1e3 * left_mm, 3)));
}

int whole_cuts(const Job& job, double cuts) {
  if (!(cuts <= kMaxCuts))
    throw InputError(job.where("process.roughing_depth_um"),
                     fmt::format("must give at most {} cuts per facet, but {} um gives {:.3g} cuts", kMaxCuts,
                                 job.process.roughing_depth_um, cuts));
  return std::max(1, static_cast<int>(std::ceil(cuts - kWholeTolerance)));
}

double shortest_plough_mm(const Job& job, const Section& section) {
  return 1e-3 * (job.process.roughing_depth_um / std::sin(section.apex.rad()) + job.tool.edge_radius_um);
}

Routine unidirectional_routine(const Job& job, const Section& section) {
  const Process& process = job.process;
  const double left_mm = finishing_allowance_mm(job);
  const double across_mm = slices_across_mm(section, left_mm);
  const double share = first_slice_thickness_ratio(section);
  const double dip_mm = edge_dip_mm(section);
  const int cuts = cuts_per_facet(job, section.stock_mm);
  const auto wall_y = [&](int cut) {
    return section.wall_y * (left_mm + roughing_remainder_mm(job, across_mm, cut, cuts, share, dip_mm));
  };
  Routine routine;
  SectionPath path(routine, start_of_cut(section, wall_y(1), process.clearance_mm), section.step_nm);
  for (int cut = 1; cut <= cuts; ++cut) {
    const double y = wall_y(cut);
    const Vec2 root(y, section.floor_z(y, left_mm));
    path.to(start_of_cut(section, y, process.clearance_mm), Motion::translate, process.retract_feed_mm_per_min);
    path.to(root, Motion::plunge, process.roughing_feed_mm_per_min);
    path.dwell(process.dwell_s);
    const Vec2 end = plough(path, job, section, root);
    path.to(start_of_cut(section, end.x(), process.clearance_mm), Motion::retract, process.retract_feed_mm_per_min);
  }
  return routine;
}

Routine plunge_routine(const Job& job, const Section& section, double left_mm, double feed_mm_per_min) {
  const Process& process = job.process;
  const double y = section.wall_y * left_mm;
  Routine routine;
  SectionPath path(routine, start_of_cut(section, y, process.clearance_mm), section.step_nm);
  Vec2 at(y, section.floor_z(y, left_mm));
  path.to(at, Motion::plunge, feed_mm_per_min);
  path.dwell(process.dwell_s);
  if (process.slow_retract_um > 0.0) {
    at += Vec2(0.0, 1e-3 * process.slow_retract_um);
    path.to(at, Motion::retract, feed_mm_per_min);
  }
  path.to(on_clearance_plane(section, at, section.bisector, process.clearance_mm), Motion::retract,
          process.retract_feed_mm_per_min);
  return routine;
}

std::string zero_text(const Job& job) {
  return job.substrate ? "Zero: centre of the array, as high as the highest place of the blank"
                       : "Zero: centre of the array on the face of the blank";
}

ProcessFacts plunging_facts(const Job& job, double stock_mm, std::size_t elements) {
  const geometry::RtpElement element = blank_prism(job);
  ProcessFacts facts;
  facts.cuts_per_facet = cuts_per_facet(job, stock_mm);
  facts.passes_mm = pass_offsets_mm(element.width_mm, job.tool.width_mm);
  facts.array_title = "Prism array";
  facts.description = {
      fmt::format("{} elements, base {} width {} apex {} deg, root {} mm deep", elements, shortest(element.base_mm),
                  shortest(element.width_mm), shortest(element.apex_angle_deg), fixed(root_depth_mm(element), 6)),
      zero_text(job) + ", roof edges along X at A0 C0. Controller transformation off",
      fmt::format("Tool: width {} mm, wedge {} deg, clearance {} deg as mounted. Reference: middle of the edge",
                  shortest(job.tool.width_mm), shortest(job.tool.wedge_deg), shortest(job.tool.clearance_deg))};
  return facts;
}

std::vector<double> pass_offsets_mm(double width_mm, double tool_width_mm) {
  const int passes =
      std::max(1, static_cast<int>(std::ceil((width_mm - kFitToleranceMm) / tool_width_mm - kWholeTolerance)));
  std::vector<double> offsets;
  for (int k = 0; k < passes; ++k)
    offsets.push_back(passes == 1 ? 0.0 : (width_mm - tool_width_mm) * (static_cast<double>(k) / (passes - 1) - 0.5));
  return offsets;
}

}  // namespace retrace::fabrication
