#include "fabrication/turning/check/envelope.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/angle.h"
#include "core/error.h"

namespace retrace::fabrication::turning {
namespace {

constexpr std::uint8_t kAxisZ = 1U << 2U;

}  // namespace

void CutRecorder::motion(const NcMotion& motion, const NcSettings&) {
  const bool moves_z_alone = (motion.moved & static_cast<std::uint8_t>(~kAxisZ)) == 0;
  if (motion.move == NcMove::rapid || (moves_z_alone && pass_.x_mm.empty())) {
    end_pass();
    return;
  }
  if (findings_.empty() && motion.is_exact_stop)
    findings_.push_back(
        {"stops", "", motion.location.line, -1, "the tool stops at every point of the cut (exact stop)", 0.0, 0.0, 1});
  if (findings_.empty() && !(motion.duration_s > 0.0))
    findings_.push_back(
        {"untimed", "", motion.location.line, -1, "the duration of a cutting move is not defined", 0.0, 0.0, 1});
  const auto add = [&](const AxisPositions& p, double duration_s) {
    pass_.duration_s.push_back(duration_s);
    pass_.line.push_back(motion.location.line);
    pass_.x_mm.push_back(p.x_mm);
    pass_.y_mm.push_back(p.y_mm);
    pass_.z_mm.push_back(p.z_mm);
    pass_.c_rad.push_back(p.c_deg * kRadPerDeg);
  };
  if (pass_.x_mm.empty()) {
    add(motion.from, 0.0);
    pass_.block_s.push_back(0.0);
  }
  add(motion.to, motion.duration_s);
  pass_.seconds += motion.duration_s;
  block_s_ += motion.duration_s;
  pass_.block_s.push_back(motion.is_continued ? 0.0 : std::exchange(block_s_, 0.0));
}

void CutRecorder::dwell(double, const NcLocation&, const AxisPositions&) {}

void CutRecorder::end_pass() {
  if (!pass_.x_mm.empty()) passes_.push_back(std::move(pass_));
  pass_ = {};
}

std::vector<CutPass> CutRecorder::take() {
  end_pass();
  return std::move(passes_);
}

Envelope::Envelope(const TurningTool& tool, std::vector<CutPass> passes)
    : radius_mm_(tool.nose_radius_mm),
      reach_mm_(tool.nose_radius_mm * std::sin(0.5 * tool.window_deg * kRadPerDeg)),
      sin_rake_(std::sin(tool.rake_deg * kRadPerDeg)),
      cos_rake_(std::cos(tool.rake_deg * kRadPerDeg)),
      passes_(std::move(passes)) {
  for (const CutPass& pass : passes_) indices_.push_back(index_of(pass));
}

Envelope::Index Envelope::index_of(const CutPass& pass) const {
  Index index;
  const std::size_t n = pass.c_rad.size();
  bool rises = true;
  bool stands = true;
  bool y_falls = true;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    rises = rises && pass.c_rad[i] < pass.c_rad[i + 1];
    stands = stands && pass.c_rad[i] == pass.c_rad[i + 1];
    y_falls = y_falls && pass.y_mm[i] > pass.y_mm[i + 1];
  }
  if (!rises && !(stands && y_falls))
    throw InputError("in a cut, C must increase throughout, or stay constant while Y decreases throughout");
  index.is_spiral = rises;
  if (!rises) return index;
  for (std::size_t i = 0; i < n; ++i) {
    const auto turn = static_cast<std::size_t>((pass.c_rad[i] - pass.c_rad[0]) / kTwoPi);
    while (index.turns.size() <= turn) index.turns.push_back({i, pass.x_mm[i], pass.x_mm[i]});
    index.turns.back().x_low = std::min(index.turns.back().x_low, pass.x_mm[i]);
    index.turns.back().x_high = std::max(index.turns.back().x_high, pass.x_mm[i]);
  }
  // The move between the last point of a turn and the first point of the next turn belongs to both turns.
  for (std::size_t t = 0; t + 1 < index.turns.size(); ++t) {
    const double x = pass.x_mm[index.turns[t + 1].first];
    index.turns[t].x_low = std::min(index.turns[t].x_low, x);
    index.turns[t].x_high = std::max(index.turns[t].x_high, x);
  }
  return index;
}

double Envelope::lift_mm(double aside_mm) const {
  return aside_mm * aside_mm / (radius_mm_ + std::sqrt(radius_mm_ * radius_mm_ - aside_mm * aside_mm));
}

void Envelope::cross_turning(const CutPass& pass, const Index& index, double x_mm, double y_mm, double& lowest) const {
  const double r = std::hypot(x_mm, y_mm);
  const double theta = std::atan2(y_mm, x_mm);
  const double start = pass.c_rad.front();
  for (std::size_t t = 0; t < index.turns.size(); ++t) {
    const Turn& turn = index.turns[t];
    // The edge can pass over the point on the tool's side of the spindle. Near the centre, it can also pass over it on
    // the opposite side.
    for (const bool beyond : {false, true}) {
      const double y = pass.y_mm[turn.first];
      if (std::abs(y) >= r) continue;
      const double x = (beyond ? -1.0 : 1.0) * std::sqrt(r * r - y * y);
      const double margin = 0.01 * reach_mm_ + 0.01 * std::abs(y);
      if (x < turn.x_low - reach_mm_ - margin || x > turn.x_high + reach_mm_ + margin) continue;
      const double phase = (beyond ? std::numbers::pi - std::asin(y / r) : std::asin(y / r)) - theta - start;
      const double within = phase - kTwoPi * std::floor(phase / kTwoPi);
      const double c = start + kTwoPi * static_cast<double>(t) + within;
      cross_at(pass, r, theta, c, lowest);
      // Near the beginning or the end of a turn, the crossing may belong to the neighbouring turn.
      constexpr double kNear = 0.5;
      if (within < kNear) cross_at(pass, r, theta, c + kTwoPi, lowest);
      if (within > kTwoPi - kNear) cross_at(pass, r, theta, c - kTwoPi, lowest);
    }
  }
}

void Envelope::cross_at(const CutPass& pass, double r, double theta, double c, double& lowest) const {
  double aside = 0.0;
  double z = 0.0;
  double miss = 1.0;
  for (int step = 0; step < 8; ++step) {
    const auto next = std::upper_bound(pass.c_rad.begin(), pass.c_rad.end(), c);
    const auto k = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(
        next - pass.c_rad.begin() - 1, 0, static_cast<std::ptrdiff_t>(pass.c_rad.size()) - 2));
    const double share = (c - pass.c_rad[k]) / (pass.c_rad[k + 1] - pass.c_rad[k]);
    const double tool_x = pass.x_mm[k] + share * (pass.x_mm[k + 1] - pass.x_mm[k]);
    const double tool_y = pass.y_mm[k] + share * (pass.y_mm[k + 1] - pass.y_mm[k]);
    z = pass.z_mm[k] + share * (pass.z_mm[k + 1] - pass.z_mm[k]);
    aside = r * std::cos(theta + c) - tool_x;
    if (std::abs(aside) > reach_mm_) return;
    miss = r * std::sin(theta + c) - tool_y - lift_mm(aside) * sin_rake_;
    c -= miss / (r * std::cos(theta + c));
    if (std::abs(miss) < 1e-13) break;
  }
  if (std::abs(miss) > 1e-9 || c < pass.c_rad.front() || c > pass.c_rad.back()) return;
  lowest = std::min(lowest, z + lift_mm(aside) * cos_rake_);
}

void Envelope::cross_line(const CutPass& pass, double x_mm, double y_mm, double& lowest) const {
  const double c = pass.c_rad.front();
  const double x = x_mm * std::cos(c) - y_mm * std::sin(c);
  const double y = x_mm * std::sin(c) + y_mm * std::cos(c);
  // X may change along the line. The lateral distance and the position along the line are therefore found together by
  // Newton's method.
  double at = y;
  constexpr int kMaxSteps = 20;
  for (int step = 0; step < kMaxSteps; ++step) {
    const auto above = std::lower_bound(pass.y_mm.begin(), pass.y_mm.end(), at, std::greater<>());
    if (above == pass.y_mm.begin() && at > pass.y_mm.front()) return;
    if (above == pass.y_mm.end()) return;
    const auto k = static_cast<std::size_t>(std::max<std::ptrdiff_t>(above - pass.y_mm.begin(), 1)) - 1;
    const double across = (pass.x_mm[k + 1] - pass.x_mm[k]) / (pass.y_mm[k + 1] - pass.y_mm[k]);
    const double aside = x - (pass.x_mm[k] + across * (at - pass.y_mm[k]));
    if (std::abs(aside) > reach_mm_) return;
    const double miss = at - y + lift_mm(aside) * sin_rake_;
    if (std::abs(miss) < 1e-13) {
      const double share = (at - pass.y_mm[k]) / (pass.y_mm[k + 1] - pass.y_mm[k]);
      const double z = pass.z_mm[k] + share * (pass.z_mm[k + 1] - pass.z_mm[k]);
      lowest = std::min(lowest, z + lift_mm(aside) * cos_rake_);
      return;
    }
    const double lift_slope = aside / std::sqrt(radius_mm_ * radius_mm_ - aside * aside);
    at -= miss / (1.0 - lift_slope * across * sin_rake_);
  }
}

std::optional<double> Envelope::height_mm(double x_mm, double y_mm) const {
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < passes_.size(); ++i) {
    if (indices_[i].is_spiral)
      cross_turning(passes_[i], indices_[i], x_mm, y_mm, lowest);
    else
      cross_line(passes_[i], x_mm, y_mm, lowest);
  }
  if (std::isinf(lowest)) return std::nullopt;
  return lowest;
}

}  // namespace retrace::fabrication::turning
