// Compares arcs that are approximated by chords with true circles, which have smooth normals. The reference traces rays
// in the plane perpendicular to the grooves.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "raytrace/exact/beam_tracer.h"
#include "tests/support/designs.h"

namespace retrace::testing::round_edges_test {
namespace {

using namespace geometry;
using namespace raytrace;

constexpr double kBase = 0.5, kThickness = 0.5, kConeDeg = 0.5;

/// A point or a direction in the plane across the grooves.
struct Vec {
  double x = 0.0, z = 0.0;
};

Vec operator*(double s, Vec v) {
  return {s * v.x, s * v.z};
}
Vec operator+(Vec a, Vec b) {
  return {a.x + b.x, a.z + b.z};
}
double dot(Vec a, Vec b) {
  return a.x * b.x + a.z * b.z;
}

/// Grooves of 90 degrees with circular roots, at x = 0, base, ..., and circular rims. The part is above the grooves.
class Grooves {
 public:
  Grooves(double root_mm, double rim_mm) : root_mm_(root_mm), rim_mm_(rim_mm) {}

  struct Hit {
    double t = INFINITY;
    Vec normal;  ///< out of the part
  };

  /// Returns the first face that a ray hits from the side on which the ray is (inside or outside the part).
  Hit first_hit(Vec from, Vec along, bool inside) const {
    Hit best;
    // The surface is in the layer between the roots and z = 0.
    const bool falls = along.z < 0.0;
    const double slowness = 1.0 / std::max(1e-3, std::abs(along.z));
    const double enters = falls ? std::max(0.0, from.z) * slowness : 0.0;
    const double leaves = slowness * std::max(0.0, falls ? from.z + 0.5 * kBase : -from.z);
    if (leaves <= enters) return best;
    const auto [low, high] = std::minmax({from.x + enters * along.x, from.x + leaves * along.x});
    const auto first = static_cast<int>(std::floor(low / kBase - 0.5));
    const auto last = static_cast<int>(std::ceil(high / kBase + 0.5));
    for (int m = first; m <= last; ++m) {
      const double x = m * kBase;
      for (const double side : {-1.0, 1.0}) meet_plane(best, from, along, inside, x, side);
      meet_circle(best, from, along, inside, {x, -0.5 * kBase + std::numbers::sqrt2 * root_mm_}, root_mm_, -1.0);
      meet_circle(best, from, along, inside, {x + 0.5 * kBase, -std::numbers::sqrt2 * rim_mm_}, rim_mm_, 1.0);
    }
    return best;
  }

 private:
  static constexpr double kStart = 1e-11;

  void meet_plane(Hit& best, Vec from, Vec along, bool inside, double root_x, double side) const {
    const Vec normal = 1.0 / std::numbers::sqrt2 * Vec{side, -1.0};
    const double towards = dot(normal, along);
    if (inside ? towards <= 0.0 : towards >= 0.0) return;
    const double t = (dot(normal, {root_x, -0.5 * kBase}) - dot(normal, from)) / towards;
    const double off = side * (from.x + t * along.x - root_x);
    const double begins = root_mm_ / std::numbers::sqrt2;
    const double ends = 0.5 * kBase - rim_mm_ / std::numbers::sqrt2;
    if (t > kStart && t < best.t && off >= begins && off <= ends) best = {t, normal};
  }

  /// Intersects a quarter of a circle. It is below the center for a root (vertical = -1), and above the center for a
  /// rim.
  static void meet_circle(Hit& best, Vec from, Vec along, bool inside, Vec centre, double radius_mm, double vertical) {
    if (radius_mm <= 0.0) return;
    const Vec to = from + -1.0 * centre;
    const double b = dot(to, along);
    const double c = dot(to, to) - radius_mm * radius_mm;
    if (b * b < c) return;
    for (const double t : {-b - std::sqrt(b * b - c), -b + std::sqrt(b * b - c)}) {
      const Vec out = 1.0 / radius_mm * (to + t * along);
      const Vec normal = -vertical * out;
      const bool meets = inside ? dot(normal, along) > 0.0 : dot(normal, along) < 0.0;
      if (meets && t > kStart && t < best.t && vertical * out.z >= 1.0 / std::numbers::sqrt2) best = {t, normal};
    }
  }

  double root_mm_;
  double rim_mm_;
};

struct Path {
  Vec at;
  Vec along;
  bool inside = true;
  std::array<double, 2> power{};  ///< power of s and p
  int events = 0;
};

double total(const Path& path) {
  return 0.5 * (path.power[0] + path.power[1]);
}

/// Returns the reflected and the refracted path at an interface, with their power by Fresnel's formulas for s and p.
std::array<std::optional<Path>, 2> branches(const Path& path, Vec normal_out) {
  const double ratio = path.inside ? kPmma : 1.0 / kPmma;
  const Vec against = path.inside ? -1.0 * normal_out : normal_out;
  const double cos_in = -dot(against, path.along);
  const double cos2_out = 1.0 - ratio * ratio * (1.0 - cos_in * cos_in);
  Path reflected = path;
  reflected.along = path.along + 2.0 * cos_in * against;
  if (cos2_out <= 0.0) return {reflected, std::nullopt};
  const double cos_out = std::sqrt(cos2_out);
  const std::array<double, 2> r = {(ratio * cos_in - cos_out) / (ratio * cos_in + cos_out),
                                   (cos_in - ratio * cos_out) / (cos_in + ratio * cos_out)};
  Path refracted = path;
  refracted.along = ratio * path.along + (ratio * cos_in - cos_out) * against;
  refracted.inside = !path.inside;
  for (const std::size_t k : {0U, 1U}) {
    reflected.power[k] *= r[k] * r[k];
    refracted.power[k] *= 1.0 - r[k] * r[k];
  }
  return {reflected, refracted};
}

/// Returns the RRE of infinite grooves, traced with evenly spaced rays in the plane perpendicular to the grooves.
double rre_of_circles(double root_mm, double rim_mm, double incidence_deg, int rays) {
  const Grooves grooves(root_mm, rim_mm);
  const double incidence = incidence_deg * std::numbers::pi / 180.0;
  const Vec to_source{std::sin(incidence), std::cos(incidence)};
  const double cone = kConeDeg * std::numbers::pi / 180.0;
  double returned = 0.0;
  std::vector<Path> pending;
  const auto leave = [&](const Path& path) {
    if (std::acos(std::min(1.0, dot(path.along, to_source))) <= cone) returned += total(path);
  };
  for (int i = 0; i < rays; ++i) {
    const Path incoming{{kBase * (i + 0.5) / rays, kThickness}, -1.0 * to_source, false, {1.0, 1.0}};
    const auto [front, entered] = branches(incoming, {0.0, 1.0});
    leave(*front);
    pending.push_back(*entered);
    while (!pending.empty()) {
      Path path = pending.back();
      pending.pop_back();
      if (!(total(path) >= 1e-6) || ++path.events > 200) continue;
      Grooves::Hit hit = grooves.first_hit(path.at, path.along, path.inside);
      const double up = path.along.z > 0.0 ? (kThickness - path.at.z) / path.along.z : INFINITY;
      const bool at_face = path.inside && up < hit.t;
      if (at_face) hit = {up, {0.0, 1.0}};
      if (hit.t == INFINITY) continue;  // travels away from the facets
      path.at = path.at + hit.t * path.along;
      path.at.x -= kBase * std::floor(path.at.x / kBase);
      for (const std::optional<Path>& next : branches(path, hit.normal)) {
        if (next && at_face && !next->inside)
          leave(*next);
        else if (next)
          pending.push_back(*next);
      }
    }
  }
  return returned / rays;
}

double rre_of_chords(double root_mm, double rim_mm, double incidence_deg, int chords) {
  PartSpec spec = infinite(RtpElement{kBase, 0.5, 90.0}, Arrangement::aligned, kThickness);
  spec.edges = {root_mm, 0.0, rim_mm, 0.0, chords};
  BeamPolicy policy;
  policy.cutoff = 1e-9;
  return BeamTracer(build_part(spec))
      .trace(pmma(), from(incidence_deg), {kConeDeg}, policy)
      .ledgers[0][Account::retroreflected];
}

TEST(RoundEdges, TwoTracersAgreeOnSharpEdges) {
  for (const double incidence_deg : {0.0, 3.0, 20.0})
    EXPECT_NEAR(rre_of_circles(0.0, 0.0, incidence_deg, 50000), rre_of_chords(0.0, 0.0, incidence_deg, 16), 5e-5);
}

// An arc that consists of chords has plane strips, and all light of one strip is either inside or outside of the cone.
// On a true circle, only some of the light of a strip may be inside. The results therefore differ by at most one strip
// for each arc.
TEST(RoundEdges, ChordsConvergeToCircles) {
  constexpr double sampling = 1e-4;
  for (const auto& [root_mm, rim_mm] : {std::array{0.02, 0.0}, std::array{0.0, 0.02}, std::array{0.05, 0.05}})
    for (const double incidence_deg : {0.0, 2.0, 10.0}) {
      const double circles = rre_of_circles(root_mm, rim_mm, incidence_deg, 20000);
      for (const int chords : {8, 16, 32, 64}) {
        const double strips = 0.5 * std::numbers::pi / chords * (root_mm + rim_mm) / kBase;
        const double difference = rre_of_chords(root_mm, rim_mm, incidence_deg, chords) - circles;
        EXPECT_LT(std::abs(difference), strips + sampling)
            << root_mm << ", " << rim_mm << ", " << incidence_deg << ", " << chords;
        RecordProperty(fmt::format("r{}_{}_at{}_{}", root_mm, rim_mm, incidence_deg, chords),
                       fmt::format("{:.6f} {:+.1e}", circles, difference));
      }
    }
}

}  // namespace
}  // namespace retrace::testing::round_edges_test
