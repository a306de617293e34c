#include "fabrication/turning/check/contact_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/angle.h"
#include "core/number_format.h"
#include "core/threads.h"
#include "fabrication/turning/check/deviation_map.h"

namespace retrace::fabrication::turning {
namespace {

using geometry::FreeformSurface;
using geometry::Vec2;

constexpr double kNowhere = -std::numeric_limits<double>::infinity();
/// Maximum number of separate findings of one kind. Further findings are merged with the last one.
constexpr std::size_t kMaxFindings = 200;
/// Tolerance, in mm, for points at the border of the region. Positions in programs are rounded to whole nanometres.
constexpr double kBorderMm = 1e-6;

struct Pose {
  double x_mm = 0.0;
  double y_mm = 0.0;
  double z_mm = 0.0;
  double c_rad = 0.0;
};

/// Contact of the tool's edge with the surface at one pose. Heights are Z positions of the tool at which it would touch
/// the surface.
struct EdgeContact {
  double touches_mm = kNowhere;         ///< Z at which any point of the arc touches the surface
  double touches_within_mm = kNowhere;  ///< Z at which a point of the arc inside the region touches the surface
  double angle_rad = 0.0;               ///< angle of the point on the arc that touches at `touches_mm`
  double angle_within_rad = 0.0;        ///< angle of the point on the arc that touches at `touches_within_mm`
};

/// Finds the point of contact between edge and surface. It maximizes the height of the surface above the edge along the
/// arc, without derivatives.
class EdgeProbe {
 public:
  explicit EdgeProbe(const TurnedPart& part)
      : surface_(part.surface),
        region_(region_of(part.path)),
        radius_mm_(part.tool.nose_radius_mm),
        sin_rake_(std::sin(part.tool.rake_deg * kRadPerDeg)),
        cos_rake_(std::cos(part.tool.rake_deg * kRadPerDeg)),
        end_rad_(0.5 * part.tool.window_deg * kRadPerDeg) {}

  /// Returns the point of the part below a point of the arc.
  Vec2 place(const Pose& at, double angle) const {
    const double x = at.x_mm + radius_mm_ * std::sin(angle);
    const double y = at.y_mm + lift_mm(angle) * sin_rake_;
    const double cosine = std::cos(at.c_rad);
    const double sine = std::sin(at.c_rad);
    return {x * cosine + y * sine, y * cosine - x * sine};
  }

  /// Returns the Z position at which a point of the arc touches the surface. Returns kNowhere if the surface is not
  /// defined at this point.
  double touches_mm(const Pose& at, double angle) const {
    const Vec2 p = place(at, angle);
    const double z = surface_.height_mm(p.x(), p.y()) - lift_mm(angle) * cos_rake_;
    return std::isfinite(z) ? z : kNowhere;
  }

  bool is_within(const Pose& at, double angle) const {
    const Vec2 p = place(at, angle);
    if (region_.is_round) return p.norm() <= region_.radius_mm + kBorderMm;
    return std::abs(p.x()) <= region_.half_height_mm + kBorderMm &&
           std::abs(p.y()) <= region_.half_width_mm + kBorderMm;
  }

  /// Computes the contact at a pose.
  /// \param start_rad angle of the previous point of contact, where the search begins
  /// \param looks_all_over true: the whole arc is searched
  EdgeContact stand(const Pose& at, double start_rad, bool looks_all_over) const {
    EdgeContact stand;
    stand.angle_rad = start_rad;
    stand.touches_mm = climb(at, stand.angle_rad);
    take_within(at, stand.angle_rad, stand.touches_mm, stand);
    if (looks_all_over) look_all_over(at, stand);
    if (!is_within(at, stand.angle_rad)) look_at_border(at, stand);
    return stand;
  }

  /// Converts a distance along Z to a distance along the surface normal at a point of the arc.
  double square(const Pose& at, double angle, double along_z) const {
    const Vec2 p = place(at, angle);
    const auto g = surface_.gradient(p.x(), p.y());
    return along_z / std::sqrt(1.0 + g.x * g.x + g.y * g.y);
  }

 private:
  double lift_mm(double angle) const { return radius_mm_ * (1.0 - std::cos(angle)); }

  void take_within(const Pose& at, double angle, double touches, EdgeContact& stand) const {
    if (touches <= stand.touches_within_mm || !is_within(at, angle)) return;
    stand.touches_within_mm = touches;
    stand.angle_within_rad = angle;
  }

  /// Returns the angle, on the arc, of the centre of the part of the arc that is inside the region. In plan, the arc is
  /// approximated by a straight line. This is exact for tools without rake.
  double inner_angle(const Pose& at) const {
    const Vec2 tip = place(at, 0.0);
    const Vec2 across(std::cos(at.c_rad), -std::sin(at.c_rad));
    const double reach = radius_mm_ * std::sin(end_rad_);
    double low = -reach;
    double high = reach;
    const auto clip = [&](double middle, double half) {
      low = std::max(low, middle - half);
      high = std::min(high, middle + half);
    };
    if (region_.is_round) {
      const double middle = -tip.dot(across);
      const double distance = (tip + middle * across).norm();
      clip(middle, std::sqrt(std::max(0.0, region_.radius_mm * region_.radius_mm - distance * distance)));
    } else {
      const double halves[] = {region_.half_height_mm, region_.half_width_mm};
      for (Eigen::Index axis = 0; axis < 2; ++axis)
        if (across[axis] != 0.0) clip(-tip[axis] / across[axis], halves[axis] / std::abs(across[axis]));
    }
    return std::asin(std::clamp(0.5 * (low + high), -reach, reach) / radius_mm_);
  }

  /// Evaluates the two points at which the arc crosses the border of the region. If the point of contact is outside of
  /// the region, the closest point inside the region can be one of these two.
  void look_at_border(const Pose& at, EdgeContact& stand) const {
    const double inner = inner_angle(at);
    if (!is_within(at, inner)) return;
    constexpr int kBisections = 40;
    for (const double end : {-end_rad_, end_rad_}) {
      double inside = inner;
      double outside = end;
      for (int k = 0; k < kBisections; ++k) {
        const double middle = 0.5 * (inside + outside);
        (is_within(at, middle) ? inside : outside) = middle;
      }
      take_within(at, inside, touches_mm(at, inside), stand);
    }
  }

  /// Searches the whole arc, because a steep part of the surface may touch a distant point of the arc first.
  void look_all_over(const Pose& at, EdgeContact& stand) const {
    constexpr int kPlaces = 10;
    std::array<double, kPlaces + 1> z{};
    std::array<double, kPlaces + 1> angles{};
    for (int i = 0; i <= kPlaces; ++i) {
      const auto k = static_cast<std::size_t>(i);
      angles[k] = end_rad_ * (2.0 * i / kPlaces - 1.0);
      z[k] = touches_mm(at, angles[k]);
      take_within(at, angles[k], z[k], stand);
    }
    for (std::size_t k = 0; k < z.size(); ++k) {
      const bool is_top = (k == 0 || z[k] >= z[k - 1]) && (k + 1 == z.size() || z[k] >= z[k + 1]);
      // Estimate of the maximum between the neighbouring samples: z[k] plus the larger difference to a neighbour.
      // Narrow features of the surface may exceed this estimate.
      if (!is_top) continue;
      const double below = std::max(k > 0 ? z[k] - z[k - 1] : 0.0, k + 1 < z.size() ? z[k] - z[k + 1] : 0.0);
      if (z[k] + below < stand.touches_mm) continue;
      double angle = angles[k];
      const double top = climb(at, angle);
      take_within(at, angle, top, stand);
      if (top <= stand.touches_mm) continue;
      stand.touches_mm = top;
      stand.angle_rad = angle;
    }
  }

  /// Finds the local maximum next to an angle, with increasing steps and then with parabolas through three points.
  double climb(const Pose& at, double& angle) const {
    constexpr double kMinStep = 0.01;
    constexpr double kMaxStep = 0.16;
    constexpr int kMaxSteps = 60;
    double step = kMinStep;
    angle = std::clamp(angle, -end_rad_, end_rad_);
    double best = touches_mm(at, angle);
    for (int k = 0; k < kMaxSteps; ++k) {
      const double low = std::max(angle - step, -end_rad_);
      const double high = std::min(angle + step, end_rad_);
      const double z_low = touches_mm(at, low);
      const double z_high = touches_mm(at, high);
      if (z_low > best || z_high > best) {
        angle = z_low > z_high ? low : high;
        best = std::max(z_low, z_high);
        step = std::min(2.0 * step, kMaxStep);
        continue;
      }
      const double top = vertex(low, angle, high, z_low, best, z_high);
      const double z_top = touches_mm(at, top);
      if (z_top > best) {
        best = z_top;
        angle = top;
      }
      if (step <= kMinStep) return best;
      step = std::max(0.25 * step, kMinStep);
    }
    return best;
  }

  /// Returns the position of the maximum of the parabola through three points.
  /// \pre the point at b is higher than the points at a and c
  static double vertex(double a, double b, double c, double za, double zb, double zc) {
    const double left = (b - a) * (zb - zc);
    const double right = (b - c) * (zb - za);
    const double bend = left - right;
    if (!(std::abs(bend) > 0.0) || !std::isfinite(bend)) return b;
    return std::clamp(b - 0.5 * ((b - a) * left - (b - c) * right) / bend, a, c);
  }

  const FreeformSurface& surface_;
  InspectedRegion region_;
  double radius_mm_;
  double sin_rake_;
  double cos_rake_;
  double end_rad_;
};

/// Result for one block, or for one pose of the tool.
struct BlockDeviation {
  double low_nm = 0.0;   ///< lowest height of the edge relative to the surface, inside the region; <= 0
  double high_nm = 0.0;  ///< largest distance of the edge above the surface, inside the region
  /// Distance between edge and surface at the point of contact, if this point is outside of the region.
  double beyond_nm = 0.0;
  double touches_mm = kNowhere;
  double angle_rad = 0.0;  ///< angle, on the arc, of the point of contact at the end of the block
  bool is_within = false;  ///< true if this point of contact is inside the region
};

/// Joins the findings of consecutive blocks into one finding with the worst value.
class Stretch {
 public:
  Stretch(const char* kind, const TurningCuts& cuts, FindingList& findings)
      : kind_(kind), cuts_(cuts), findings_(findings) {
    now_.count = 0;
  }

  /// Adds the finding of one block.
  /// \param message function that returns the text of the finding
  template <typename Message>
  void add(std::size_t program, std::int32_t line, double nm, double limit_nm, const Message& message) {
    if (now_.count == 0 || nm > now_.value)
      now_ = {kind_, cuts_.programs[program], line, -1, message(), nm, limit_nm, now_.count};
    ++now_.count;
  }

  /// Ends the current finding. If kMaxFindings is reached, the finding stays open, and it also includes all further
  /// blocks.
  void end() {
    if (told_ < kMaxFindings) close();
  }
  /// Ends the current finding, even if it is the last allowed one.
  void close() {
    if (now_.count > 0) {
      findings_.add(now_);
      ++told_;
    }
    now_.count = 0;
  }

 private:
  const char* kind_;
  const TurningCuts& cuts_;
  FindingList& findings_;
  std::size_t told_ = 0;
  Finding now_;
};

class TouchCheck {
 public:
  TouchCheck(const TurnedPart& part, const TurningCuts& cuts, FindingList& findings)
      : probe_(part),
        limit_nm_(part.form_tolerance_nm),
        gouge_("gouge", cuts, findings),
        excess_("excess", cuts, findings) {}

  void follow(const CutPass& pass) {
    std::vector<BlockDeviation> all(pass.size());
    constexpr std::size_t kPiece = 2048;
    for_each_in_parallel((pass.size() + kPiece - 1) / kPiece, [&](std::size_t piece) {
      double angle = 0.0;
      const std::size_t end_of_piece = std::min(pass.size(), (piece + 1) * kPiece);
      for (std::size_t i = piece * kPiece; i < end_of_piece; ++i) {
        stand(pose_at(pass, i, 1.0), true, angle, all[i]);
        if (i == 0) continue;
        double half_way = angle;
        stand(pose_at(pass, i, 0.5), false, half_way, all[i]);
      }
    });
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (i > 0 && all[i].is_within != all[i - 1].is_within) stand_at_border(pass, i, all[i]);
      take(all[i], pass.program, pass.line[i], pass.servo_mm.empty() ? 0.0 : pass.servo_mm[i]);
      if (all[i].beyond_nm > limit_nm_) add_border_places(pass, i, all[i].angle_rad);
    }
    end_stretches();
  }

  /// Checks the end point of a downward move for gouges. Material that is left is not checked at this point, because
  /// the tool may be above the surface.
  void follow(const DownMove& move) {
    BlockDeviation standing;
    double angle = 0.0;
    stand({move.at.x_mm, move.at.y_mm, move.at.z_mm + move.stroke_mm, move.at.c_deg * kRadPerDeg}, true, angle,
          standing);
    standing.high_nm = 0.0;
    standing.touches_mm = kNowhere;
    take(standing, move.program, move.line, 0.0);
    end_stretches();
  }

  ContactFigures take_figures() { return std::move(figures_); }

 private:
  /// Returns the pose within the block that ends at point `i`.
  /// \param share fraction of the block: 0 at its beginning, 1 at its end
  static Pose pose_at(const CutPass& pass, std::size_t i, double share) {
    const auto at = [i, share](const std::vector<double>& v) {
      return share == 1.0 ? v[i] : v[i - 1] + share * (v[i] - v[i - 1]);
    };
    return {at(pass.x_mm), at(pass.y_mm), at(pass.z_mm), at(pass.c_rad)};
  }

  void stand(const Pose& at, bool looks_all_over, double& angle, BlockDeviation& standing) const {
    const EdgeContact s = probe_.stand(at, angle, looks_all_over);
    angle = s.angle_rad;
    if (looks_all_over) {
      standing.touches_mm = s.touches_mm;
      standing.angle_rad = s.angle_rad;
      standing.is_within = probe_.is_within(at, s.angle_rad);
    }
    if (s.touches_within_mm == kNowhere) return;
    const double below = 1e6 * (s.touches_within_mm - at.z_mm);
    if (below > 0.0) standing.low_nm = std::min(standing.low_nm, -probe_.square(at, s.angle_within_rad, below));
    if (below >= 0.0) return;
    if (s.touches_within_mm >= s.touches_mm)
      standing.high_nm = std::max(standing.high_nm, -probe_.square(at, s.angle_within_rad, below));
    else
      standing.beyond_nm = std::max(standing.beyond_nm, probe_.square(at, s.angle_rad, 1e6 * (at.z_mm - s.touches_mm)));
  }

  /// Evaluates the pose in which the point of contact crosses the border of the region.
  void stand_at_border(const CutPass& pass, std::size_t i, BlockDeviation& standing) const {
    double inside = standing.is_within ? 1.0 : 0.0;
    double outside = 1.0 - inside;
    double angle = standing.angle_rad;
    constexpr int kBisections = 20;
    for (int k = 0; k < kBisections; ++k) {
      const double middle = 0.5 * (inside + outside);
      const Pose at = pose_at(pass, i, middle);
      angle = probe_.stand(at, angle, false).angle_rad;
      (probe_.is_within(at, angle) ? inside : outside) = middle;
    }
    stand(pose_at(pass, i, inside), false, angle, standing);
  }

  void add_border_places(const CutPass& pass, std::size_t i, double angle) {
    for (const double share : {0.5, 1.0}) {
      if (i == 0 && share < 1.0) continue;
      const Pose at = pose_at(pass, i, share);
      const EdgeContact s = probe_.stand(at, angle, true);
      if (s.touches_within_mm == kNowhere) continue;
      const auto square_nm = [&](double mm) { return probe_.square(at, s.angle_within_rad, 1e6 * mm); };
      figures_.border.push_back({probe_.place(at, s.angle_within_rad), square_nm(at.z_mm - s.touches_within_mm),
                                 square_nm(s.touches_mm - s.touches_within_mm), pass.program, pass.line[i]});
    }
  }

  void take(const BlockDeviation& standing, std::size_t program, std::int32_t line, double stroke_mm) {
    figures_.low_nm = std::min(figures_.low_nm, standing.low_nm);
    figures_.high_nm = std::max(figures_.high_nm, standing.high_nm);
    if (standing.touches_mm > kNowhere)
      figures_.highest_mm = std::max(figures_.highest_mm.value_or(kNowhere), standing.touches_mm - stroke_mm);
    add(gouge_, "the edge goes below the surface", -standing.low_nm, program, line);
    add(excess_, "the edge stays above the surface", standing.high_nm, program, line);
  }

  void add(Stretch& stretch, const char* what, double nm, std::size_t program, std::int32_t line) const {
    if (!(nm > limit_nm_)) return stretch.end();
    stretch.add(program, line, nm, limit_nm_, [&] {
      return fmt::format("{} by {} nm, which exceeds the tolerance of {} nm", what, fixed_apart(nm, limit_nm_, 2),
                         shortest(limit_nm_));
    });
  }

  void end_stretches() {
    gouge_.close();
    excess_.close();
  }

  EdgeProbe probe_;
  double limit_nm_;
  ContactFigures figures_;
  Stretch gouge_;
  Stretch excess_;
};

}  // namespace

InspectedRegion region_of(const PathOptions& path) {
  InspectedRegion region;
  region.is_round = path.strategy == Strategy::spiral;
  region.radius_mm = path.radius_mm;
  region.half_width_mm = 0.5 * path.width_mm;
  region.half_height_mm = 0.5 * path.height_mm;
  region.feed_mm = path.feed_mm;
  return region;
}

ContactFigures check_contact(const TurnedPart& part, const TurningCuts& cuts, FindingList& findings) {
  TouchCheck check(part, cuts, findings);
  for (const CutPass& pass : cuts.passes) check.follow(pass);
  for (const DownMove& move : cuts.down_moves) check.follow(move);
  return check.take_figures();
}

void check_border(const TurnedPart& part, const TurningCuts& cuts, const Envelope& envelope, ContactFigures& figures,
                  FindingList& findings) {
  Stretch excess("excess", cuts, findings);
  const BorderPoint* last = nullptr;
  for (const BorderPoint& place : figures.border) {
    const bool follows = last != nullptr && last->program == place.program && place.line <= last->line + 1;
    if (!follows) excess.end();
    last = &place;
    const double left_nm = deviation_nm(envelope, part.surface, place.at_mm).value_or(place.edge_nm);
    figures.high_nm = std::max(figures.high_nm, left_nm - place.touching_nm);
    const double limit_nm = place.touching_nm + part.form_tolerance_nm;
    if (!(left_nm > limit_nm)) {
      excess.end();
      continue;
    }
    excess.add(place.program, place.line, left_nm, limit_nm, [&] {
      return fmt::format(
          "the edge stays above the surface: {} nm of material remain at the border of the part, but at most {} nm are "
          "allowed (the tolerance of {} nm plus the material that remains after a cut with contact)",
          fixed_apart(left_nm, limit_nm, 2), fixed(limit_nm, 2), shortest(part.form_tolerance_nm));
    });
  }
  excess.close();
}

}  // namespace retrace::fabrication::turning
