#include "fabrication/chisel/check/simulation/convex_polygons.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace retrace::fabrication {
namespace {

using geometry::Vec2;

/// Minimum thickness, in mm, of polygons that are kept. It is far above the rounding errors in an element.
constexpr double kThinMm = 1e-9;

bool is_outside(const ConvexPolygon& piece, const HalfPlane& side) {
  return std::all_of(piece.begin(), piece.end(), [&](const Vec2& p) { return side.signed_distance_mm(p) > -kThinMm; });
}

bool is_inside(const ConvexPolygon& piece, const HalfPlane& side) {
  return std::all_of(piece.begin(), piece.end(), [&](const Vec2& p) { return side.signed_distance_mm(p) < kThinMm; });
}

/// Returns true if a polygon is thinner than kThinMm. The thickness is estimated as area divided by circumference.
bool is_thin(const ConvexPolygon& piece) {
  if (piece.size() < 3) return true;
  double area = 0.0;
  double around = 0.0;
  for (std::size_t i = 0; i < piece.size(); ++i) {
    const Vec2 a = piece[i] - piece.front();
    const Vec2 b = piece[(i + 1) % piece.size()] - piece.front();
    area += a.x() * b.y() - a.y() * b.x();
    around += (b - a).norm();
  }
  return std::abs(area) < kThinMm * around;
}

/// Subtracts a convex body (an intersection of half-planes) from one polygon and adds the remaining parts to `left`.
/// \return the subtracted part. If it is empty, nothing was subtracted and `left` is unchanged
ConvexPolygon take_from(const ConvexPolygon& piece, std::span<const HalfPlane> body, std::vector<ConvexPolygon>& left) {
  if (std::any_of(body.begin(), body.end(), [&](const HalfPlane& side) { return is_outside(piece, side); })) return {};
  const std::size_t before = left.size();
  ConvexPolygon rest = piece;
  for (const HalfPlane& side : body) {
    if (is_inside(rest, side)) continue;
    ConvexPolygon off = clipped(rest, {-side.outward, -side.bound_mm});
    if (!is_thin(off)) left.push_back(std::move(off));
    rest = clipped(rest, side);
    if (!is_thin(rest)) continue;
    left.resize(before);
    return {};
  }
  return rest;
}

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
};

/// Polygon, and the positions of the parallel lines that cross it. The position of a line is its coordinate
/// perpendicular to the lines.
struct Chords {
  const ConvexPolygon* piece = nullptr;
  Range reach;
};

double length_at(const ConvexPolygon& piece, const Vec2& across, double at) {
  Range chord;
  for (std::size_t i = 0; i < piece.size(); ++i) {
    const Vec2& a = piece[i];
    const Vec2& b = piece[i + 1 == piece.size() ? 0 : i + 1];
    const double over_a = across.dot(a) - at;
    const double over_b = across.dot(b) - at;
    if ((over_a < 0.0) == (over_b < 0.0)) continue;
    const Vec2 p = a + (b - a) * (over_a / (over_a - over_b));
    const double v = across.x() * p.y() - across.y() * p.x();
    chord.low = std::min(chord.low, v);
    chord.high = std::max(chord.high, v);
  }
  return std::max(0.0, chord.high - chord.low);
}

}  // namespace

ConvexPolygon clipped(const ConvexPolygon& piece, const HalfPlane& to) {
  ConvexPolygon result;
  if (piece.empty()) return result;
  result.reserve(piece.size() + 1);
  double over_b_before = to.signed_distance_mm(piece.front());
  for (std::size_t i = 0; i < piece.size(); ++i) {
    const Vec2& a = piece[i];
    const Vec2& b = piece[i + 1 == piece.size() ? 0 : i + 1];
    const double over_a = over_b_before;
    const double over_b = to.signed_distance_mm(b);
    over_b_before = over_b;
    if (over_a <= 0.0) result.push_back(a);
    if ((over_a < 0.0 && over_b > 0.0) || (over_a > 0.0 && over_b < 0.0))
      result.push_back(a + (b - a) * (over_a / (over_a - over_b)));
  }
  return result;
}

std::vector<ConvexPolygon> subtract(std::vector<ConvexPolygon>& pieces, std::span<const HalfPlane> body) {
  std::vector<ConvexPolygon> taken;
  std::vector<ConvexPolygon> left;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    ConvexPolygon part = take_from(pieces[i], body, left);
    if (!part.empty()) {
      taken.push_back(std::move(part));
      continue;
    }
    if (kept != i) pieces[kept] = std::move(pieces[i]);
    ++kept;
  }
  pieces.resize(kept);
  std::move(left.begin(), left.end(), std::back_inserter(pieces));
  return taken;
}

double chord_mm(const ConvexPolygon& piece, const Vec2& point, const Vec2& direction, double low, double high) {
  const Vec2 across(-direction.y(), direction.x());
  const double at = across.dot(point);
  Range chord;
  for (std::size_t i = 0; i < piece.size(); ++i) {
    const Vec2& a = piece[i];
    const Vec2& b = piece[(i + 1) % piece.size()];
    const double over_a = across.dot(a) - at;
    const double over_b = across.dot(b) - at;
    if ((over_a < 0.0) == (over_b < 0.0)) continue;
    const double s = direction.dot(a + (b - a) * (over_a / (over_a - over_b)) - point);
    chord.low = std::min(chord.low, s);
    chord.high = std::max(chord.high, s);
  }
  return std::max(0.0, std::min(chord.high, high) - std::max(chord.low, low));
}

std::vector<LineLength> line_lengths(std::span<const ConvexPolygon> pieces, const Vec2& across,
                                     std::span<const double> also) {
  // The length jumps at a polygon edge that is parallel to the lines. It is therefore evaluated on both sides of each
  // corner.
  constexpr double kBesideMm = kThinMm;
  std::vector<Chords> chords;
  std::vector<double> places(also.begin(), also.end());
  for (const ConvexPolygon& piece : pieces) {
    Chords& added = chords.emplace_back();
    added.piece = &piece;
    for (const Vec2& corner : piece) {
      const double at = across.dot(corner);
      added.reach.low = std::min(added.reach.low, at);
      added.reach.high = std::max(added.reach.high, at);
      places.push_back(at - kBesideMm);
      places.push_back(at + kBesideMm);
    }
  }
  std::sort(places.begin(), places.end());
  const auto is_same = [](double a, double b) { return b - a < 0.5 * kBesideMm; };
  places.erase(std::unique(places.begin(), places.end(), is_same), places.end());
  std::sort(chords.begin(), chords.end(), [](const Chords& a, const Chords& b) { return a.reach.low < b.reach.low; });
  std::vector<const Chords*> crossed;
  std::size_t next = 0;
  std::vector<LineLength> lengths;
  lengths.reserve(places.size());
  for (const double at : places) {
    while (next < chords.size() && chords[next].reach.low < at) crossed.push_back(&chords[next++]);
    std::erase_if(crossed, [&](const Chords* chord) { return chord->reach.high <= at; });
    double length = 0.0;
    for (const Chords* const chord : crossed) length += length_at(*chord->piece, across, at);
    lengths.push_back({at, length});
  }
  return lengths;
}

}  // namespace retrace::fabrication
