#include "fabrication/chisel/check/simulation/facet_figures.h"

#include <algorithm>
#include <cmath>

#include "core/length_units.h"
#include "fabrication/chisel/check/simulation/line_moves.h"
#include "fabrication/chisel/check/simulation/plane_fit.h"

namespace retrace::fabrication {
namespace {

using geometry::Vec3;

/// Positions, along the root, of the stations and of the passes of the tool. A station is a cross-section in which the
/// facets are measured.
struct Stations {
  std::vector<double> along_mm;         ///< positions of the stations
  std::vector<double> pass_middles_mm;  ///< centre of each pass
};

/// Distance of measuring lines from the corners of the machined surface. A line exactly through a corner would be in a
/// side plane of the tool.
constexpr double kOffCornerMm = 2e-7;
/// Minimum distance from the root, in mm, at which a measuring line can distinguish the two facets.
constexpr double kMinStripMm = 2e-6;
/// Distance from the root, in mm, of the line that measures the residual material at the root.
constexpr double kAtRootMm = 1.5e-6;
/// Safety factor on the predicted width of the strip at the root that the edge leaves uncut. It allows for rounded
/// poses and positions.
constexpr double kRootMargin = 1.05;
/// Maximum distance, in mm, between the centres of two passes that count as one pass. Their ploughed surfaces differ by
/// picometres only.
constexpr double kSamePassMm = 3e-6;
/// Fraction of the facet's width that is used to fit the plane of the facet. The ends of the facet are excluded.
constexpr double kPlaneFraction = 0.8;
/// Maximum distance of a measured point from the root, in facet lengths, at which is_beside() is reliable.
constexpr double kReachRatio = 4.0;

class Measurer {
 public:
  Measurer(const PrismGroove& groove, std::span<const SweptVolume> sweeps, std::span<const RigidMotion> poses,
           const ToolWedge& wedge, const Prediction& prediction, double tolerance_mm)
      : groove_(groove), sweeps_(sweeps), poses_(poses), wedge_(wedge), prediction_(prediction) {
    for (const SweptVolume& sweep : sweeps) by_pose_.push_back({&sweep, swept_sides(wedge, sweep)});
    std::ranges::stable_sort(by_pose_, {}, [](const SweptBody& body) { return body.move->pose; });
    // Maximum tolerance for the position of a pass along the root, relative to half of the width of the element.
    constexpr double max_end_fraction = 0.01;
    find_stations(std::min(tolerance_mm, max_end_fraction * groove.half_width_mm));
    // Maximum extent, along a facet, of the tolerance layer on the other facet, relative to the facet's length.
    // Residual material within this extent is attributed to the root. The maximum only has an effect for large
    // tolerances.
    constexpr double max_layer_fraction = 0.01;
    const double layer_mm = std::min(tolerance_mm / sine_between(), max_layer_fraction * groove.facet_length_mm);
    layer_end_mm_ = kMinStripMm + layer_mm;
    strip_mm_ = kRootMargin * prediction.root_mm + layer_end_mm_;
    find_burr();
  }

  /// Returns the facet that the first cut plunges. In the pose of that cut, it is the facet whose normal is most nearly
  /// opposite to the normal of the clearance face.
  std::size_t plunged_facet() const {
    const Vec3 n = poses_[sweeps_.front().pose].direction(groove_.facets[0].normal);
    const Vec3 up = wedge_.sides[0].outward;
    return n.dot(up) < poses_[sweeps_.front().pose].direction(groove_.facets[1].normal).dot(up) ? 0 : 1;
  }

  /// Measures the deviations of a facet from the design.
  /// \param is_ploughed true if this facet is ploughed
  /// \param is_other_ploughed true if the other facet is ploughed. The predicted rise of that facet along the edge is
  ///        then taken into account
  FacetFigures measure(std::size_t facet, bool is_ploughed, bool is_other_ploughed) {
    FacetFigures figures;
    figures.is_ploughed = is_ploughed;
    const std::vector<double> slants = slant_positions(facet);
    PlaneFit plane;
    for (std::size_t k = 0; k < stations_.along_mm.size(); ++k) {
      const double along = stations_.along_mm[k];
      const double width_mm = width_of_station(k);
      select_sweeps(along);
      double previous_slant = 0.0;
      double previous_top = 0.0;
      const auto take_line = [&](double slant, const LineSurface& surface) {
        take(figures, surface, slant, is_ploughed ? ploughed_height(facet, along, slant) : Interval{});
        if (is_for_plane(slant, along)) plane.add(slant, along, surface.lowest);
        const double top = std::min(surface.top, bisector_height_mm(slant));
        figures.residual_mm3 += 0.5 * (top + previous_top) * (slant - previous_slant) * width_mm;
        previous_slant = slant;
        previous_top = top;
      };
      const double floor_mm = is_other_ploughed ? ploughed_height(1 - facet, along, 0.0).high / sine_between() : 0.0;
      take_line(kAtRootMm, at_root(facet, along, kAtRootMm + floor_mm));
      const LineFamily lines = lines_of(facet, along, slants);
      for_each_line(lines, near_, poses_, [&](std::size_t line, std::span<const SweptVolume* const> moves) {
        take_line(lines.slants_mm[line], surface_at(facet, along, lines.slants_mm[line], false, moves));
      });
    }
    plane.fit(figures);
    figures.distance_nm = std::max(figures.highest.nm, -figures.deepest.nm);
    return figures;
  }

 private:
  /// Returns the height, over a facet, of the plane that bisects the angle between the facets. Remaining stock beyond
  /// this plane belongs to the other facet, so that no volume counts twice.
  double bisector_height_mm(double slant) const {
    return slant * sine_between() / (1.0 + groove_.facets[0].up_slope.dot(groove_.facets[1].up_slope));
  }

  /// Returns the width of the facet that a station represents. It extends halfway to the neighbouring stations.
  double width_of_station(std::size_t k) const {
    const std::vector<double>& at = stations_.along_mm;
    const double low = k == 0 ? -groove_.half_width_mm : 0.5 * (at[k - 1] + at[k]);
    const double high = k + 1 == at.size() ? groove_.half_width_mm : 0.5 * (at[k] + at[k + 1]);
    return high - low;
  }

  /// Returns true if a point is used to fit the plane of a facet. Points near the root, near the rim and near the two
  /// ends of the facet are excluded.
  bool is_for_plane(double slant, double along) const {
    return std::abs(along) <= plane_end_mm_ && slant >= std::max(burr_end_mm_, 0.02 * groove_.facet_length_mm) &&
           slant <= 0.98 * groove_.facet_length_mm;
  }

  /// Computes the position and height of the burr that plunges along the two facets may leave at the root. The tips of
  /// the plunges may end above the root, by a distance of up to `t` along the facets. The burr is the material that
  /// then remains between the two rake faces (docs/theory/verification.md). If the rake faces do not intersect, the
  /// remaining material is a fin, which is not allowed.
  void find_burr() {
    const double up = wedge_.rake_direction.dot(wedge_.clearance_direction);
    const double slope = std::tan(std::acos(std::clamp(up, -1.0, 1.0)) + std::asin(wedge_.sides[0].outward.z()));
    const double sine = sine_between();
    const double cosine = groove_.facets[0].up_slope.dot(groove_.facets[1].up_slope);
    const double across = slope * sine + cosine;
    const double slope_of_other = (sine - slope * cosine) / across;
    if (slope <= slope_of_other) return;
    const double t = kRootMargin * prediction_.root_mm;
    const double end_mm = t * slope * (1.0 + 1.0 / across) / (slope - slope_of_other);
    burr_end_mm_ = strip_mm_ + end_mm;
    burr_height_mm_ = strip_mm_ + end_mm * slope;
  }

  /// Returns the position, along the root line, of the plane in which the centre of the edge moves.
  double middle_of(const SweptVolume& sweep) const {
    const Vec3& normal = prediction_.pass_normal;
    const RigidMotion& pose = poses_[sweep.pose];
    return normal.dot(sweep.to_mm - pose.point(groove_.root_mm)) / normal.dot(pose.direction(groove_.root_direction));
  }

  /// Finds the passes of the tool and the positions of the measured sections.
  /// \param end_mm tolerance for the position of a pass along the root
  void find_stations(double end_mm) {
    for (const SweptVolume& sweep : sweeps_) {
      const double middle = middle_of(sweep);
      const auto is_same = [&](double known) { return std::abs(known - middle) < kSamePassMm; };
      if (std::none_of(stations_.pass_middles_mm.begin(), stations_.pass_middles_mm.end(), is_same))
        stations_.pass_middles_mm.push_back(middle);
    }
    // The ends of a tilted edge leave thin slivers at the walls. The cuts of the neighbouring elements remove these
    // slivers, so they are not measured.
    const double margin = prediction_.wall_mm + end_mm + 2.0 * kSamePassMm;
    const double end = groove_.half_width_mm - margin;
    stations_.along_mm = {-end, -kPlaneFraction * end, kPlaneFraction * end, end};
    plane_end_mm_ = kPlaneFraction * groove_.half_width_mm;
    if (stations_.pass_middles_mm.size() > 1) add_stations_of_passes(margin, end);
  }

  /// Adds stations on both sides of every end of a pass, and at the centre of each gap between passes. Overlapping
  /// passes hide each other's errors. The added stations also measure a pass where no other pass cuts, and so reveal a
  /// pass that is missing or too high.
  /// \param margin_mm distance of a station from the end of a pass
  /// \param end_mm stations are between -end_mm and end_mm
  void add_stations_of_passes(double margin_mm, double end_mm) {
    std::vector<double>& middles = stations_.pass_middles_mm;
    std::vector<double>& along = stations_.along_mm;
    std::sort(middles.begin(), middles.end());
    const double half = wedge_.half_width_mm;
    std::vector<double> added;
    for (std::size_t k = 0; k < middles.size(); ++k) {
      for (const double end_of_pass : {middles[k] - half, middles[k] + half})
        for (const double offset : {-margin_mm, margin_mm}) added.push_back(end_of_pass + offset);
      if (k > 0 && middles[k] - middles[k - 1] > 2.0 * half + kSamePassMm)
        added.push_back(0.5 * (middles[k - 1] + middles[k]));
    }
    for (const double station : added)
      if (std::abs(station) < end_mm) along.push_back(station);
    std::sort(along.begin(), along.end());
    const auto is_same = [](double a, double b) { return b - a < kSamePassMm; };
    along.erase(std::unique(along.begin(), along.end(), is_same), along.end());
  }

  /// Returns the distances from the root at which a facet is measured. They are on both sides of every corner that the
  /// tip of the tool leaves, midway between these corners, and at equal steps over the facet.
  std::vector<double> slant_positions(std::size_t facet) const {
    std::vector<double> corners = {strip_mm_, burr_end_mm_, groove_.facet_length_mm};
    for (const SweptVolume& sweep : sweeps_)
      for (const Vec3& tip : {sweep.from_mm, sweep.to_mm}) {
        const Vec3 p = poses_[sweep.pose].inverse().point(tip);
        corners.push_back(groove_.facets[facet].up_slope.dot(p - groove_.root_mm));
      }
    std::sort(corners.begin(), corners.end());
    std::vector<double> slants = {kAtRootMm};
    const double last = groove_.facet_length_mm - kOffCornerMm;
    const auto add = [&](double slant) {
      if (slant > strip_mm_ && slant < last) slants.push_back(slant);
    };
    for (std::size_t i = 0; i < corners.size(); ++i) {
      add(corners[i] - kOffCornerMm);
      add(corners[i] + kOffCornerMm);
      if (i > 0) add(0.5 * (corners[i - 1] + corners[i]) + 1e-9);
    }
    constexpr int even_lines = 12;
    for (int i = 0; i < even_lines; ++i) add((i + 0.5137) / even_lines * groove_.facet_length_mm);
    std::sort(slants.begin(), slants.end());
    const auto is_same = [](double a, double b) { return b - a < 0.5 * kOffCornerMm; };
    slants.erase(std::unique(slants.begin(), slants.end(), is_same), slants.end());
    return slants;
  }

  /// Selects the sweeps that can cross the measuring lines of a station.
  void select_sweeps(double along) {
    near_.clear();
    near_moves_.clear();
    for (const SweptBody& body : by_pose_) {
      if (is_beside(*body.move, along)) continue;
      near_.push_back(&body);
      near_moves_.push_back(body.move);
    }
  }

  /// Returns the measuring lines of a station that are normal to a facet.
  /// \param slants distances of the lines from the root; the first one is the line at the root, which is omitted
  LineFamily lines_of(std::size_t facet, double along, std::span<const double> slants) const {
    const DesignFacet& design = groove_.facets[facet];
    LineFamily lines;
    lines.origin_mm = groove_.root_mm + along * groove_.root_direction;
    lines.up = design.up_slope;
    lines.direction = design.normal;
    lines.reach_mm = kReachRatio * groove_.facet_length_mm;
    for (const double slant : slants.subspan(1)) {
      if (!is_clear_of_other(slant)) continue;
      lines.slants_mm.push_back(slant);
      lines.exits_mm.push_back(exit_of(facet, lines.origin_mm + slant * design.up_slope));
    }
    return lines;
  }

  /// Returns true if a sweep intersects no measuring line of a station, because the whole tool remains on one side of
  /// the station. The tool is assumed to be as wide as its edge. The result is reliable for points up to kReachRatio
  /// facet lengths from the root.
  bool is_beside(const SweptVolume& sweep, double along) const {
    const RigidMotion& pose = poses_[sweep.pose];
    const Vec3 root = pose.direction(groove_.root_direction);
    const Vec3 at = pose.point(groove_.root_mm) + along * root;
    const double oblique = wedge_.edge.cross(root).norm();
    const double allowed_mm = wedge_.half_width_mm + kReachRatio * groove_.facet_length_mm * oblique;
    const double at_start_mm = wedge_.edge.dot(at - sweep.from_mm);
    const double at_end_mm = wedge_.edge.dot(at - sweep.to_mm);
    return std::min(at_start_mm, at_end_mm) > allowed_mm || std::max(at_start_mm, at_end_mm) < -allowed_mm;
  }

  /// Returns the machined surface along a measuring line.
  /// \param moves moves that may determine the surface, in the order of their poses
  LineSurface surface_at(std::size_t facet, double along, double slant, bool is_at_root,
                         std::span<const SweptVolume* const> moves) {
    const DesignFacet& design = groove_.facets[facet];
    const Vec3 point = groove_.root_mm + along * groove_.root_direction + slant * design.up_slope;
    // The residual material at the root is measured along the other facet. The result is the distance from the root at
    // which the cuts along that facet end.
    const Vec3& direction = is_at_root ? groove_.facets[1 - facet].up_slope : design.normal;
    spans_.clear();
    Vec3 p;
    Vec3 d;
    const SweptVolume* previous = nullptr;
    for (const SweptVolume* sweep : moves) {
      if (previous == nullptr || previous->pose != sweep->pose) {
        p = poses_[sweep->pose].point(point);
        d = poses_[sweep->pose].direction(direction);
      }
      previous = sweep;
      if (const auto span = swept_span(wedge_, *sweep, p, d)) spans_.push_back(*span);
    }
    return surface_along(spans_, is_at_root ? groove_.to_face_mm(point, direction) : exit_of(facet, point));
  }

  /// Measures the residual material at the root along a line close to the other facet. This line is inside the layer
  /// that the tolerance allows on the other facet. If material in this layer disturbs the result, a second line above
  /// the layer is used. The inclined rake face of the last plunge increases the result on the second line, so the
  /// thickness of the layer is subtracted.
  LineSurface at_root(std::size_t facet, double along, double slant) {
    const LineSurface close = surface_at(facet, along, slant, slant <= strip_mm_, near_moves_);
    const double above = slant + layer_end_mm_;
    if (close.top <= layer_end_mm_) return close;
    LineSurface clear = surface_at(facet, along, above, true, near_moves_);
    if (close.top <= clear.top + layer_end_mm_) return close;
    clear.top = std::max(0.0, clear.top - layer_end_mm_);
    return clear;
  }

  /// Returns the height above the other facet per mm of distance from the root. It is the sine of the angle between the
  /// facets.
  double sine_between() const { return groove_.facets[1].normal.dot(groove_.facets[0].up_slope); }

  /// Returns the rate at which a line normal to a facet approaches the other facet, in mm per mm. Returns 0 if the
  /// angle between the facets is 90 degrees or more.
  double approach_of_other() const {
    constexpr double kParallel = 1e-9;
    const double towards = -groove_.facets[0].normal.dot(groove_.facets[1].normal);
    return towards > kParallel ? towards : 0.0;
  }

  /// Returns the height above the other facet up to which a measuring line can cross residual material of that facet.
  double residue_of_other_mm() const { return strip_mm_ + kMinStripMm; }

  /// Returns true if a line at a distance from the root measures only its own facet. In grooves with an angle below 90
  /// degrees, lines near the root cross the residual material of the other facet.
  bool is_clear_of_other(double slant) const {
    if (slant <= strip_mm_ || approach_of_other() <= 0.0) return true;
    return slant * sine_between() > 2.0 * residue_of_other_mm();
  }

  /// Returns the height above a facet at which a normal line leaves the volume that the design removes. It is limited
  /// by the blank's face and by the residual material on the other facet.
  double exit_of(std::size_t facet, const Vec3& point) const {
    const DesignFacet& design = groove_.facets[facet];
    const double at_face = groove_.to_face_mm(point, design.normal);
    const double towards = approach_of_other();
    if (towards <= 0.0) return at_face;
    const double free = groove_.facets[1 - facet].height_mm(point) - residue_of_other_mm();
    return std::min(at_face, free / towards);
  }

  /// Returns the range of heights above the design facet that correct ploughing passes leave at a point. The height is
  /// 0 at the deeper end of a tilted edge. The ends of a pass are uncertain by wall_mm along the root. Within this
  /// distance of an end, the range includes the heights with and without this pass.
  /// \param along position of the point along the root, in mm
  /// \param slant distance of the point from the root along the facet, in mm
  Interval ploughed_height(std::size_t facet, double along, double slant) const {
    const PloughedFloor& floor = prediction_.ploughed[facet];
    const double half = floor.half_width_mm;
    const double rise = half * std::abs(floor.slope);
    Interval height{2.0 * rise, 2.0 * rise};
    for (const double at_root : stations_.pass_middles_mm) {
      const double middle = at_root + floor.shift_mm + floor.drift * slant;
      const double off = std::abs(along - middle);
      const double left = std::clamp(rise + floor.slope * (along - middle), 0.0, 2.0 * rise);
      if (off <= half + prediction_.wall_mm + kSamePassMm) height.low = std::min(height.low, left);
      if (off <= half - prediction_.wall_mm - 0.5 * kSamePassMm) height.high = std::min(height.high, left);
    }
    return height;
  }

  /// Updates the largest deviations of a facet with one measured point.
  /// \param predicted range of heights above the design facet in which the surface must be. Both limits are clamped to
  ///        the blank's face, because a ploughed facet that rises along the edge can leave the blank near the rim
  void take(FacetFigures& figures, const LineSurface& surface, double slant, const Interval& predicted) const {
    const double lowest_mm = std::min(surface.lowest, surface.top);
    if (slant <= strip_mm_) {
      const double left_nm = (surface.top - predicted.high / sine_between()) * kNmPerMm;
      if (left_nm > figures.root.nm) figures.root = {left_nm, surface.top_line};
      return;
    }
    const bool is_under_burr = slant < burr_end_mm_ && surface.top < burr_height_mm_;
    const double high_mm = std::min(predicted.high, surface.exit);
    const double low_mm = std::min(predicted.low, surface.exit);
    const double above_nm = ((is_under_burr ? lowest_mm : surface.top) - high_mm) * kNmPerMm;
    const double below_nm = (lowest_mm - low_mm) * kNmPerMm;
    if (above_nm > figures.highest.nm) figures.highest = {above_nm, surface.top_line};
    if (below_nm < figures.deepest.nm) figures.deepest = {below_nm, surface.lowest_line};
  }

  const PrismGroove& groove_;
  std::span<const SweptVolume> sweeps_;
  std::span<const RigidMotion> poses_;
  const ToolWedge& wedge_;
  const Prediction& prediction_;
  std::vector<SweptBody> by_pose_;              ///< all sweeps, ordered by pose
  std::vector<const SweptBody*> near_;          ///< sweeps selected by select_sweeps(), ordered by pose
  std::vector<const SweptVolume*> near_moves_;  ///< moves of `near_`
  Stations stations_;
  double strip_mm_ = 0.0;
  /// Distance from the root up to which the tolerance of the other facet affects the measurement.
  double layer_end_mm_ = 0.0;
  double plane_end_mm_ = 0.0;
  double burr_end_mm_ = 0.0;     ///< distance of the end of the burr from the root
  double burr_height_mm_ = 0.0;  ///< height of the burr above a facet
  std::vector<LineSpan> spans_;
};

}  // namespace

ElementFigures element_figures(const PrismGroove& groove, std::span<const SweptVolume> sweeps,
                               std::span<const RigidMotion> poses, const ToolWedge& wedge, const Prediction& prediction,
                               bool is_one_facet_ploughed, double tolerance_mm) {
  ElementFigures figures;
  figures.is_cut = !sweeps.empty();
  if (!figures.is_cut) return figures;
  Measurer measurer(groove, sweeps, poses, wedge, prediction, tolerance_mm);
  const std::size_t plunged = measurer.plunged_facet();
  figures.facets.resize(2);
  for (std::size_t f = 0; f < 2; ++f)
    figures.facets[f] =
        measurer.measure(f, is_one_facet_ploughed && f != plunged, is_one_facet_ploughed && f == plunged);
  return figures;
}

}  // namespace retrace::fabrication
