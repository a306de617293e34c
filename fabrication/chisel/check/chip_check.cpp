#include "fabrication/chisel/check/chip_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/number_format.h"
#include "fabrication/chisel/check/chip_limit.h"
#include "fabrication/chisel/check/cut_check.h"

namespace retrace::fabrication {
namespace {

using geometry::Vec2;
using geometry::Vec3;

/// Minimum cosine of the angle between a cross-section and the normal of the plane that the edge sweeps. Chip
/// thicknesses cannot be measured in cross-sections for which this angle is larger than 30 degrees.
constexpr double kMinInPlaneCosine = 0.87;

double standing_mm(std::span<const ConvexPolygon> pieces, const Vec2& foot, const Vec2& direction, double to_mm) {
  double sum = 0.0;
  for (const ConvexPolygon& piece : pieces) sum += chord_mm(piece, foot, direction, 0.0, to_mm);
  return sum;
}

/// Returns the point of a cross-section that a chisel's cutting edge reaches at the deeper end of a move, in
/// coordinates of the section.
/// \param tip position of the centre of the cutting edge at the deeper end of the move, in the workpiece frame
Vec2 deepest_place(const SectionPlane& plane, const ToolWedge& wedge, const RigidMotion& back, const Vec3& tip) {
  const Vec3 edge = back.direction(wedge.edge);
  const double across = plane.normal.dot(edge);
  if (wedge.half_width_mm <= 0.0 || std::abs(across) < 0.5) return plane.point(tip);
  const double by_mm = std::clamp(-plane.signed_distance_mm(tip) / across, -wedge.half_width_mm, wedge.half_width_mm);
  return plane.point(tip + by_mm * edge);
}

/// Projects the tip of a V-shaped tool onto a cross-section, parallel to the dihedral edge that crosses the section. If
/// the element has angle errors, this dihedral edge is not perpendicular to the section.
/// \param tip position of the tip at the deeper end of the move, in the workpiece frame
Vec2 deepest_place(const SectionPlane& plane, const CubeCavity& cavity, const Vec3& tip) {
  const auto across = [&](const Vec3& edge) { return std::abs(plane.normal.dot(edge)); };
  const Vec3& edge = *std::ranges::max_element(cavity.edges, {}, across);
  return plane.point(tip - plane.signed_distance_mm(tip) / plane.normal.dot(edge) * edge);
}

}  // namespace

ChipCheck::ChipCheck(const VerificationModel& workpiece, std::size_t element, RemainingStock& material,
                     const ToolWedge& wedge, std::span<const RigidMotion> poses)
    : workpiece_(workpiece),
      cavity_(workpiece.cavities[element]),
      design_(workpiece.design(element)),
      is_cube_(std::holds_alternative<CubeCavity>(cavity_)),
      element_(element),
      material_(material),
      wedge_(wedge),
      poses_(poses),
      allowance_mm_(finishing_allowance_mm(workpiece)),
      is_begun_(design_.facets.size(), false) {
  if (allowance_mm_ > 0.0) add_lines();
}

/// Adds the lines along which the thickness of the finishing layers is measured. Near the root, cuts of the other facet
/// remove parts of these layers. Near the rim, the layers extend beyond the blank. The lines keep clear of both
/// regions.
void ChipCheck::add_lines() {
  constexpr double kClearOfRoot = 6.0;  // distance from the root, relative to the allowance plus the uncut strip
  const double least_mm = kClearOfRoot * (allowance_mm_ + workpiece_.prediction(element_).root_mm);
  const std::vector<StockSection>& sections = material_.sections();
  for (std::size_t s = 0; s < sections.size(); ++s) {
    const SectionPlane& plane = sections[s].plane;
    // In a cube corner, sections close to the apex are inside the layers of the third facet.
    if (is_cube_ && (plane.origin_mm - design_.root_mm).norm() < least_mm) continue;
    for (std::size_t f = 0; f < design_.facets.size(); ++f) {
      const DesignFacet& facet = design_.facets[f];
      const Vec2 normal = plane.direction(facet.normal);
      if (normal.norm() < kMinInPlaneCosine) continue;
      FacetLine line;
      line.section = s;
      line.facet = f;
      line.direction = normal.normalized();
      const Vec2 level(line.direction.y(), -line.direction.x());
      const Vec2 up_slope = level.y() > 0.0 ? level : Vec2(-level);
      for (const double share : {0.0, 0.15, 0.35, 0.6, 0.8, 0.97}) {
        line.origin_mm = std::max(least_mm, share * design_.facet_length_mm) * up_slope;
        if (standing_mm(sections[s].polygons, line.origin_mm, line.direction, allowance_mm_) < allowance_mm_ - 1e-8)
          continue;
        lines_.push_back(line);
      }
    }
  }
}

void ChipCheck::cut(const SweptVolume& sweep) {
  const std::vector<ToolWedge::Side> sides = swept_sides(wedge_, sweep);
  const RigidMotion& pose = poses_[sweep.pose];
  std::vector<std::vector<ConvexPolygon>> removed;
  bool is_cut = false;
  for (StockSection& section : material_.sections()) {
    removed.push_back(section.cut(sides, pose));
    is_cut = is_cut || !removed.back().empty();
  }
  if (!is_cut || sweep.is_rapid) return;
  const RigidMotion back = pose.inverse();
  const std::optional<FacetCut> cut = facet_cut(design_, wedge_, sweep, back);
  check_chips(sweep, cut, back, removed);
  if (cut && is_finishing(workpiece_, *cut)) count_finishing(sweep, *cut, removed);
}

void ChipCheck::check_chips(const SweptVolume& sweep, const std::optional<FacetCut>& cut, const RigidMotion& back,
                            std::span<const std::vector<ConvexPolygon>> removed) {
  const Vec3 normal = back.direction(swept_normal(wedge_, sweep));
  const Vec3 from = back.point(sweep.from_mm);
  const Vec3 to = back.point(sweep.to_mm);
  const Vec3& tip = design_.height_over_face_mm(from) < design_.height_over_face_mm(to) ? from : to;
  const ChipLimit limit(workpiece_, element_, cut, wedge_, back);
  double worst_mm = 0.0;
  double allowed_mm = 0.0;
  double thickest_mm = 0.0;
  for (std::size_t s = 0; s < removed.size(); ++s) {
    const SectionPlane& plane = material_.sections()[s].plane;
    const Vec2 square = plane.direction(normal);
    if (removed[s].empty() || square.norm() < kMinInPlaneCosine) continue;
    const Vec2 along = Vec2(-square.y(), square.x()).normalized();
    const auto* const cavity = std::get_if<CubeCavity>(&cavity_);
    const double deepest_mm =
        along.dot(cavity != nullptr ? deepest_place(plane, *cavity, tip) : deepest_place(plane, wedge_, back, tip));
    const double beside_mm = std::min(std::abs(plane.signed_distance_mm(from)), std::abs(plane.signed_distance_mm(to)));
    std::vector<double> bends;
    for (const double bend : limit.kinks_mm())
      for (const double side : {-1.0, 1.0}) bends.push_back(deepest_mm + side * (bend + 1e-9));
    // Chip thicknesses are measured along parallel lines in a cross-section of the element. If the element has angle
    // errors, these lines are slightly inclined to the facet's normal. The factor `upright` corrects the lengths.
    const double upright = is_cube_ ? square.norm() : 1.0;
    for (const LineLength& line : line_lengths(removed[s], along, bends)) {
      const double most_mm = limit.at(std::abs(line.at_mm - deepest_mm), beside_mm);
      const double length_mm = upright * line.length_mm;
      thickest_mm = std::max(thickest_mm, length_mm);
      figures_.max_thickness_ratio = std::max(figures_.max_thickness_ratio, length_mm / most_mm);
      if (length_mm - most_mm <= worst_mm - allowed_mm) continue;
      worst_mm = length_mm;
      allowed_mm = most_mm;
    }
  }
  figures_.thickest_mm = std::max(figures_.thickest_mm, thickest_mm);
  if (cut && cut->is_by_clearance && !is_cube_) check_rubbing(sweep, *cut, thickest_mm);
  constexpr double kRoundingMm = 1e-7;
  if (worst_mm <= allowed_mm + kRoundingMm) return;
  find("chip_too_thick", sweep,
       fmt::format("the chip is {} um thick, but at a depth of cut of {} um at most {} um are allowed: a previous cut "
                   "is probably missing",
                   fixed(1e3 * worst_mm, 3), fixed(1e3 * limit.depth_mm(), 3), fixed(1e3 * allowed_mm, 3)),
       1e3 * worst_mm, 1e3 * allowed_mm);
}

void ChipCheck::check_rubbing(const SweptVolume& sweep, const FacetCut& cut, double thickest_mm) {
  const auto& least_um = workpiece_.job->process.min_chip_um;
  // On a substrate, the first cut of a facet is allowed to be arbitrarily thin.
  const bool may_be_thin = workpiece_.job->substrate && !is_begun_[cut.facet];
  is_begun_[cut.facet] = true;
  constexpr double kRoundingUm = 2e-3;
  if (!least_um || may_be_thin || thickest_mm <= 0.0 || 1e3 * thickest_mm > *least_um - kRoundingUm) return;
  find("rubs", sweep, rubbing_text(1e3 * thickest_mm, *least_um), 1e3 * thickest_mm, *least_um);
}

void ChipCheck::count_finishing(const SweptVolume& sweep, const FacetCut& cut,
                                std::span<const std::vector<ConvexPolygon>> removed) {
  const double least_mm = 5e-4 * workpiece_.job->process.finishing_depth_um;
  for (FacetLine& line : lines_) {
    if (line.facet != cut.facet || removed[line.section].empty()) continue;
    if (standing_mm(removed[line.section], line.origin_mm, line.direction, allowance_mm_) < least_mm) continue;
    ++line.finishing_cuts;
    line.last = sweep;
  }
}

void ChipCheck::find(const char* kind, const SweptVolume& sweep, std::string message, double value_um,
                     double limit_um) {
  figures_.findings.push_back(
      {kind, "", sweep.location.line, static_cast<std::int64_t>(element_), std::move(message), value_um, limit_um, 1});
  figures_.programs.push_back(sweep.program);
}

ChipFigures ChipCheck::finish() {
  const Process& process = workpiece_.job->process;
  for (const FacetLine& line : lines_) {
    // If material of the finishing layers remains on this line, the facet is not finished yet. Other checks report the
    // remaining material.
    if (line.finishing_cuts == 0 || line.finishing_cuts >= process.finishing_cuts) continue;
    if (standing_mm(material_.sections()[line.section].polygons, line.origin_mm, line.direction, allowance_mm_) >
        workpiece_.tolerance_mm)
      continue;
    find("finishing_missing", line.last,
         fmt::format("{} finishing cuts removed the last {} um of facet {}, but the process requires {} finishing cuts",
                     line.finishing_cuts, fixed(1e3 * allowance_mm_, 3), line.facet + 1, process.finishing_cuts),
         line.finishing_cuts, process.finishing_cuts);
  }
  return std::move(figures_);
}

}  // namespace retrace::fabrication
