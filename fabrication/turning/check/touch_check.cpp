#include "fabrication/turning/check/touch_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/angle.h"
#include "core/number_format.h"
#include "core/threads.h"

namespace retrace::fabrication::turning {
namespace {

using geometry::FreeformSurface;
using geometry::Vec2;

constexpr double kNowhere = -std::numeric_limits<double>::infinity();
/// Findings of one kind that are told each by itself; farther ones are counted with the last.
constexpr std::size_t kMostStretches = 200;

struct Pose {
  double x_mm = 0.0;
  double y_mm = 0.0;
  double z_mm = 0.0;
  double c_rad = 0.0;
};

/// How a pose of the tool stands to the surface. Heights are those of its Z at which it would touch.
struct Stand {
  double touches_mm = kNowhere;         ///< whatever place of the arc does
  double touches_within_mm = kNowhere;  ///< where the place lies in the region
  double angle_rad = 0.0;               ///< on the arc, of the first
  double angle_within_rad = 0.0;
};

/// The edge over the surface: finds the highest of surface less edge along the arc, without derivatives.
class EdgeProbe {
 public:
  explicit EdgeProbe(const TurnedPart& part)
      : surface_(part.surface),
        region_(region_of(part.path)),
        radius_mm_(part.tool.nose_radius_mm),
        sin_rake_(std::sin(part.tool.rake_deg * kDegree)),
        cos_rake_(std::cos(part.tool.rake_deg * kDegree)),
        end_rad_(0.5 * part.tool.window_deg * kDegree) {}

  /// The place of the part under a place of the arc.
  Vec2 place(const Pose& at, double angle) const {
    const double x = at.x_mm + radius_mm_ * std::sin(angle);
    const double y = at.y_mm + lift_mm(angle) * sin_rake_;
    const double cosine = std::cos(at.c_rad);
    const double sine = std::sin(at.c_rad);
    return {x * cosine + y * sine, y * cosine - x * sine};
  }

  /// Z at which the tool touches there. A surface that has no height holds nothing up.
  double touches_mm(const Pose& at, double angle) const {
    const Vec2 p = place(at, angle);
    const double z = surface_.height_mm(p.x(), p.y()) - lift_mm(angle) * cos_rake_;
    return std::isfinite(z) ? z : kNowhere;
  }

  bool is_within(const Pose& at, double angle) const {
    const Vec2 p = place(at, angle);
    if (region_.is_round) return p.norm() <= region_.radius_mm;
    return std::abs(p.x()) <= region_.half_height_mm && std::abs(p.y()) <= region_.half_width_mm;
  }

  /// \param start_rad angle near which it touched last
  Stand stand(const Pose& at, double start_rad, bool looks_all_over) const {
    Stand stand;
    stand.angle_rad = start_rad;
    stand.touches_mm = climb(at, stand.angle_rad);
    take_within(at, stand.angle_rad, stand.touches_mm, stand);
    if (looks_all_over) look_all_over(at, stand);
    return stand;
  }

  /// Square to the surface where the arc touches it.
  double square(const Pose& at, double angle, double along_z) const {
    const Vec2 p = place(at, angle);
    const auto g = surface_.gradient(p.x(), p.y());
    return along_z / std::sqrt(1.0 + g.x * g.x + g.y * g.y);
  }

 private:
  double lift_mm(double angle) const { return radius_mm_ * (1.0 - std::cos(angle)); }

  void take_within(const Pose& at, double angle, double touches, Stand& stand) const {
    if (touches <= stand.touches_within_mm || !is_within(at, angle)) return;
    stand.touches_within_mm = touches;
    stand.angle_within_rad = angle;
  }

  /// A steep place farther along the arc may touch first, and beyond the region's rim there may be a higher one.
  void look_all_over(const Pose& at, Stand& stand) const {
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
      // Between its neighbours a top is not higher than this by more than it is above them, but for narrow features.
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

  /// Goes up from an angle to the top beside it: ever longer steps, then parabolas through three places.
  double climb(const Pose& at, double& angle) const {
    constexpr double kLeastStep = 0.01;
    constexpr double kMostStep = 0.16;
    constexpr int kMostSteps = 60;
    double step = kLeastStep;
    angle = std::clamp(angle, -end_rad_, end_rad_);
    double best = touches_mm(at, angle);
    for (int k = 0; k < kMostSteps; ++k) {
      const double low = std::max(angle - step, -end_rad_);
      const double high = std::min(angle + step, end_rad_);
      const double z_low = touches_mm(at, low);
      const double z_high = touches_mm(at, high);
      if (z_low > best || z_high > best) {
        angle = z_low > z_high ? low : high;
        best = std::max(z_low, z_high);
        step = std::min(2.0 * step, kMostStep);
        continue;
      }
      const double top = vertex(low, angle, high, z_low, best, z_high);
      const double z_top = touches_mm(at, top);
      if (z_top > best) {
        best = z_top;
        angle = top;
      }
      if (step <= kLeastStep) return best;
      step = std::max(0.25 * step, kLeastStep);
    }
    return best;
  }

  /// Where the parabola through three places is highest, the middle one above both others.
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

/// What a block, or one place of the tool, was found to do.
struct Standing {
  double low_nm = 0.0;
  double high_nm = 0.0;
  double touches_mm = kNowhere;
};

class TouchCheck {
 public:
  TouchCheck(const TurnedPart& part, const TurningCuts& cuts, FindingList& findings)
      : probe_(part), limit_nm_(part.form_tolerance_nm), cuts_(cuts), findings_(findings) {}

  void follow(const CutPass& pass) {
    std::vector<Standing> all(pass.size());
    constexpr std::size_t kPiece = 2048;
    for_each_in_parallel((pass.size() + kPiece - 1) / kPiece, [&](std::size_t piece) {
      double angle = 0.0;
      const std::size_t end_of_piece = std::min(pass.size(), (piece + 1) * kPiece);
      for (std::size_t i = piece * kPiece; i < end_of_piece; ++i) {
        const Pose end{pass.x_mm[i], pass.y_mm[i], pass.z_mm[i], pass.c_rad[i]};
        stand(end, true, angle, all[i]);
        if (i == 0) continue;
        const auto half = [i](const std::vector<double>& v) { return 0.5 * (v[i - 1] + v[i]); };
        double half_way = angle;
        stand({half(pass.x_mm), half(pass.y_mm), half(pass.z_mm), half(pass.c_rad)}, false, half_way, all[i]);
      }
    });
    for (std::size_t i = 0; i < all.size(); ++i)
      take(all[i], pass.program, pass.line[i], pass.servo_mm.empty() ? 0.0 : pass.servo_mm[i]);
    end_stretches();
  }

  /// Where the tool comes down it may stand off.
  void follow(const DownMove& move) {
    Standing standing;
    double angle = 0.0;
    stand({move.at.x_mm, move.at.y_mm, move.at.z_mm + move.stroke_mm, move.at.c_deg * kDegree}, true, angle, standing);
    standing.high_nm = 0.0;
    standing.touches_mm = kNowhere;
    take(standing, move.program, move.line, 0.0);
    end_stretches();
  }

  const TouchFigures& figures() const { return figures_; }

 private:
  /// Blocks that follow each other and do the same.
  struct Stretch {
    const char* kind;
    const char* message;
    std::size_t told = 0;
    Finding now{};
  };

  void stand(const Pose& at, bool looks_all_over, double& angle, Standing& standing) const {
    const Stand s = probe_.stand(at, angle, looks_all_over);
    angle = s.angle_rad;
    if (looks_all_over) standing.touches_mm = s.touches_mm;
    if (s.touches_within_mm == kNowhere) return;
    const double below = 1e6 * (s.touches_within_mm - at.z_mm);
    if (below > 0.0) standing.low_nm = std::min(standing.low_nm, -probe_.square(at, s.angle_within_rad, below));
    // It is to touch in the region, unless a place beyond that holds it up.
    if (below < 0.0 && s.touches_within_mm >= s.touches_mm)
      standing.high_nm = std::max(standing.high_nm, -probe_.square(at, s.angle_within_rad, below));
  }

  void take(const Standing& standing, std::size_t program, std::int32_t line, double stroke_mm) {
    figures_.low_nm = std::min(figures_.low_nm, standing.low_nm);
    figures_.high_nm = std::max(figures_.high_nm, standing.high_nm);
    if (standing.touches_mm > kNowhere)
      figures_.highest_mm = std::max(figures_.highest_mm.value_or(kNowhere), standing.touches_mm - stroke_mm);
    add(gouge_, -standing.low_nm, program, line);
    add(excess_, standing.high_nm, program, line);
  }

  void add(Stretch& stretch, double nm, std::size_t program, std::int32_t line) {
    if (!(nm > limit_nm_)) {
      if (stretch.told < kMostStretches) end(stretch);
      return;
    }
    if (stretch.now.count == 0 || nm > stretch.now.value) {
      stretch.now.kind = stretch.kind;
      stretch.now.program = cuts_.programs[program];
      stretch.now.line = line;
      stretch.now.value = nm;
      stretch.now.limit = limit_nm_;
      stretch.now.message = fmt::format("{} by {} nm, which exceeds the tolerance of {} nm", stretch.message,
                                        fixed_apart(nm, limit_nm_, 2), shortest(limit_nm_));
    }
    ++stretch.now.count;
  }

  void end(Stretch& stretch) {
    if (stretch.now.count > 0) {
      findings_.add(stretch.now);
      ++stretch.told;
    }
    stretch.now = {};
    stretch.now.count = 0;
  }

  void end_stretches() {
    end(gouge_);
    end(excess_);
  }

  EdgeProbe probe_;
  double limit_nm_;
  const TurningCuts& cuts_;
  FindingList& findings_;
  TouchFigures figures_;
  Stretch gouge_{"gouge", "the edge goes below the surface", 0, none()};
  Stretch excess_{"excess", "the edge stays off the surface", 0, none()};

  static Finding none() {
    Finding finding;
    finding.count = 0;
    return finding;
  }
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

TouchFigures check_touch(const TurnedPart& part, const TurningCuts& cuts, FindingList& findings) {
  TouchCheck check(part, cuts, findings);
  for (const CutPass& pass : cuts.passes) check.follow(pass);
  for (const DownMove& move : cuts.down_moves) check.follow(move);
  return check.figures();
}

}  // namespace retrace::fabrication::turning
