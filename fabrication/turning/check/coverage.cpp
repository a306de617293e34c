#include "fabrication/turning/check/coverage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/angle.h"
#include "core/number_format.h"

namespace retrace::fabrication::turning {
namespace {

/// Tolerance, in mm, for distances between positions that are rounded to whole nanometres.
constexpr double kPlacesMm = 3e-6;
/// Maximum distance, in mm, of the tool from the line that its skew determines.
constexpr double kOffSkewMm = 1e-4;
constexpr double kSameDeg = 2e-6;

class CoverageCheck {
 public:
  CoverageCheck(const TurnedPart& part, const TurningCuts& cuts, FindingList& findings)
      : part_(part), path_(part.path), cuts_(cuts), findings_(findings) {}

  CoverageFigures run() {
    for (const CutPass& pass : cuts_.passes) check_direction(pass);
    if (cuts_.passes.empty()) {
      add_uncut(0, 0, "no cut was found", 0.0, 0.0);
      figures_.is_monotonic = false;
    }
    if (!figures_.is_monotonic) return figures_;
    if (path_.strategy == Strategy::spiral)
      check_turns();
    else
      check_lines();
    return figures_;
  }

 private:
  bool is_spiral() const { return path_.strategy == Strategy::spiral; }

  void add(const char* kind, const CutPass& pass, std::size_t i, std::string message, double value, double limit) {
    findings_.add({kind, cuts_.programs[pass.program], pass.line[i], -1, std::move(message), value, limit, 1});
  }
  void add_uncut(std::size_t program, std::int32_t line, std::string message, double value, double limit) {
    figures_.is_complete = false;
    findings_.add({"uncut", cuts_.programs.empty() ? "" : cuts_.programs[program], line, -1, std::move(message), value,
                   limit, 1});
  }

  /// Checks that all blocks of a pass move forward. Only the first wrong block of a pass is reported.
  void check_direction(const CutPass& pass) {
    for (std::size_t i = 1; i < pass.size(); ++i) {
      const bool rises = pass.c_rad[i - 1] < pass.c_rad[i];
      const bool falls = pass.c_rad[i - 1] == pass.c_rad[i] && pass.y_mm[i - 1] > pass.y_mm[i];
      if (is_spiral() ? rises : falls) continue;
      figures_.is_monotonic = false;
      add("direction", pass, i,
          is_spiral() ? "C does not increase along the cut" : "along the line, C changes or Y does not decrease", 0.0,
          0.0);
      return;
    }
  }

  // Functions for spirals.

  static double radius(const CutPass& pass, std::size_t i) { return std::hypot(pass.x_mm[i], pass.y_mm[i]); }

  /// Returns the radius at an angle of C, interpolated in a pass.
  static double radius_at(const CutPass& pass, double c_rad) {
    const auto next = std::upper_bound(pass.c_rad.begin(), pass.c_rad.end(), c_rad);
    const auto k = static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(next - pass.c_rad.begin(), 1, static_cast<std::ptrdiff_t>(pass.size()) - 1));
    const double share = (c_rad - pass.c_rad[k - 1]) / (pass.c_rad[k] - pass.c_rad[k - 1]);
    return radius(pass, k - 1) + share * (radius(pass, k) - radius(pass, k - 1));
  }

  /// Returns the radius of the previous turn at an angle of C, if that turn is in an earlier pass. If no earlier pass
  /// contains the angle, returns the radius of the part.
  double radius_before(std::size_t pass, double c_rad) const {
    for (std::size_t j = pass; j-- > 0;) {
      const CutPass& before = cuts_.passes[j];
      const double end = before.c_rad.back();
      const double at = end - std::fmod(std::fmod(end - c_rad, kTwoPi) + kTwoPi, kTwoPi);
      if (at >= before.c_rad.front()) return radius_at(before, at);
    }
    return path_.radius_mm;
  }

  void check_turns() {
    const double cosine = std::cos(part_.tool.skew_deg * kRadPerDeg);
    const double sine = std::sin(part_.tool.skew_deg * kRadPerDeg);
    for (std::size_t k = 0; k < cuts_.passes.size(); ++k) {
      const CutPass& pass = cuts_.passes[k];
      for (std::size_t i = 0; i < pass.size(); ++i) {
        const double c = pass.c_rad[i];
        const double before = c - kTwoPi >= pass.c_rad.front() ? radius_at(pass, c - kTwoPi) : radius_before(k, c);
        check_step(pass, i, before - radius(pass, i));
        const double off = std::abs(pass.x_mm[i] * sine + pass.y_mm[i] * cosine);
        if (off > kOffSkewMm)
          add("skew", pass, i,
              fmt::format("the tool is {} mm away from the line on which its skew is correct", fixed(off, 6)), off,
              kOffSkewMm);
      }
    }
    const CutPass& last = cuts_.passes.back();
    const double end = radius(last, last.size() - 1);
    if (end > path_.feed_mm + kPlacesMm)
      add_uncut(last.program, last.line.back(), "the cuts end before they reach the centre", end, path_.feed_mm);
  }

  // Functions for the lines of a raster.

  /// Returns a point of a line in the part frame: coordinates across and along the lines.
  geometry::Vec2 place(const CutPass& pass, std::size_t i) const {
    const double cosine = std::cos(pass.c_rad[i]);
    const double sine = std::sin(pass.c_rad[i]);
    return {pass.x_mm[i] * cosine + pass.y_mm[i] * sine, pass.y_mm[i] * cosine - pass.x_mm[i] * sine};
  }

  /// Returns the position of a line, measured across the lines, at a position along the lines. Returns nothing beyond
  /// the ends of the line.
  static std::optional<double> across_at(const std::vector<geometry::Vec2>& line, double along) {
    if (line.empty() || along > line.front().y() + kPlacesMm || along < line.back().y() - kPlacesMm)
      return std::nullopt;
    const auto next =
        std::lower_bound(line.begin(), line.end(), along, [](const geometry::Vec2& p, double y) { return p.y() > y; });
    const auto k = std::clamp<std::ptrdiff_t>(next - line.begin(), 1, static_cast<std::ptrdiff_t>(line.size()) - 1);
    const geometry::Vec2& a = line[static_cast<std::size_t>(k) - 1];
    const geometry::Vec2& b = line[static_cast<std::size_t>(k)];
    return a.x() + (b.x() - a.x()) * (a.y() - along) / (a.y() - b.y());
  }

  void check_lines() {
    const double half_along = 0.5 * path_.width_mm - kPlacesMm;
    const double half_across = 0.5 * path_.height_mm;
    std::vector<geometry::Vec2> before;
    for (const CutPass& pass : cuts_.passes) {
      std::vector<geometry::Vec2> line;
      for (std::size_t i = 0; i < pass.size(); ++i) line.push_back(place(pass, i));
      if (std::abs(pass.c_rad.front() / kRadPerDeg + part_.tool.skew_deg) > kSameDeg)
        add("skew", pass, 1, "the position of C does not match the tool's skew", pass.c_rad.front() / kRadPerDeg,
            -part_.tool.skew_deg);
      if (line.front().y() < half_along || line.back().y() > -half_along)
        add_uncut(pass.program, pass.line.front(), "a line does not extend over the whole part",
                  line.front().y() - line.back().y(), path_.width_mm);
      for (std::size_t i = 0; i < line.size(); ++i) {
        const std::optional<double> neighbour = across_at(before, line[i].y());
        if (neighbour) check_step(pass, i, *neighbour - line[i].x());
      }
      if (before.empty())
        check_edge(pass, pass.line.front(), half_across - lowest_across(line), "the first line is inside the border");
      before = std::move(line);
    }
    const CutPass& last = cuts_.passes.back();
    double end = -half_across;
    for (const geometry::Vec2& p : before) end = std::max(end, p.x());
    check_edge(last, last.line.back(), end + half_across, "the last line ends before the border");
  }

  static double lowest_across(const std::vector<geometry::Vec2>& line) {
    return std::min_element(line.begin(), line.end(), [](const auto& a, const auto& b) { return a.x() < b.x(); })->x();
  }

  /// Checks that the outermost line is at most half a feed inside the border of the part. The cusps between two lines
  /// are highest at half a feed from each line. A wider strip at the border would therefore be higher than the cusps.
  void check_edge(const CutPass& pass, std::int32_t line, double inside_mm, const char* what) {
    const double limit_mm = 0.5 * path_.feed_mm;
    if (inside_mm <= limit_mm + kPlacesMm) return;
    add_uncut(pass.program, line,
              fmt::format("{} of the part by {} um, but at most half the feed ({} um) is allowed", what,
                          fixed_apart(1e3 * inside_mm, 1e3 * limit_mm, 3), fixed(1e3 * limit_mm, 3)),
              inside_mm, limit_mm);
  }

  /// Checks the distance to the previous cut. Consecutive blocks with too large a distance give one finding.
  void check_step(const CutPass& pass, std::size_t i, double step_mm) {
    figures_.step_mm_max = std::max(figures_.step_mm_max, step_mm);
    const bool is_wide = step_mm > path_.feed_mm + kPlacesMm;
    if (is_wide && !was_wide_)
      add("feed_step", pass, i,
          fmt::format("the distance to the previous cut is {} um, but at most the feed of {} um is allowed",
                      fixed_apart(1e3 * step_mm, 1e3 * path_.feed_mm, 3), fixed(1e3 * path_.feed_mm, 3)),
          step_mm, path_.feed_mm);
    was_wide_ = is_wide;
    // In a gap wider than the nose, a part of the surface is not cut at all.
    if (step_mm > path_.feed_mm + 2.0 * part_.tool.nose_radius_mm) figures_.is_complete = false;
  }

  const TurnedPart& part_;
  const PathOptions& path_;
  const TurningCuts& cuts_;
  FindingList& findings_;
  CoverageFigures figures_;
  bool was_wide_ = false;
};

}  // namespace

CoverageFigures check_coverage(const TurnedPart& part, const TurningCuts& cuts, FindingList& findings) {
  return CoverageCheck(part, cuts, findings).run();
}

}  // namespace retrace::fabrication::turning
