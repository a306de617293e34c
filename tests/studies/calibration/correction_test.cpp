#include "studies/calibration/correction.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "core/error.h"
#include "fabrication/chisel/check/verify.h"
#include "tests/support/prism_jobs.h"

// Parts that the verifier cuts on machines with hidden errors, seen by a profiler with noise, at a place and askew as
// nobody knows: correction must find the machine, and say how sure it is.

namespace retrace::studies::correction_test {
namespace {

using namespace fabrication;
using geometry::Vec3;
using test::hidden_errors, test::programs_of;

/// Four prisms with land of 0.25 mm between them.
const FabricationResult& plan() {
  static const FabricationResult made = test::planned(test::prism_job({90.0, 0.25, 10.0, 1}));
  return made;
}

/// The planes that the verifier finds of a part's facets, and the face, as a surface over the plane.
class CutSurface {
 public:
  explicit CutSurface(const Machine& real) : grooves_(designed_grooves(plan().job)), map_(grooves_) {
    static const std::vector<NcProgram> programs = programs_of(plan());
    const Verification v = verify_programs(plan().job, real, programs, {}, {});
    for (std::size_t element = 0; element < grooves_.size(); ++element)
      for (std::size_t facet = 0; facet < 2; ++facet) {
        const FacetFigures& f = v.elements[element].figures.facets[facet];
        const DesignFacet& design = grooves_[element].facets[facet];
        const Vec3 along = grooves_[element].level_of(facet);
        const Vec3 point = grooves_[element].root_mm + f.mean_up_mm * design.up_slope + f.mean_along_mm * along +
                           1e-6 * f.mean_nm * design.normal;
        const Vec3 normal = (design.normal - f.slope_up * design.up_slope - f.slope_along * along).normalized();
        planes_.emplace_back(normal, point);
      }
  }

  double z(double x, double y) const {
    const auto element = map_.at(x, y);
    if (!element) return 0.0;
    double z = -1e9;
    for (const auto& [normal, point] : {planes_[2 * *element], planes_[2 * *element + 1]})
      z = std::max(z, point.z() - (normal.x() * (x - point.x()) + normal.y() * (y - point.y())) / normal.z());
    return std::min(z, 0.0);
  }

 private:
  std::vector<Groove> grooves_;
  GrooveMap map_;
  std::vector<std::pair<Vec3, Vec3>> planes_;
};

/// What an instrument sees of all of the part, with 5 nm of noise; 220 points a row are 6 um apart.
FacetMap seen(const CutSurface& surface, std::mt19937& bits, std::size_t points = 220) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const Eigen::AngleAxisd turn(0.02 * uniform(bits), Vec3::UnitZ());
  const Eigen::AngleAxisd tip(0.003 * uniform(bits), Vec3(uniform(bits), uniform(bits), 0.0).normalized());
  const Eigen::Matrix3d part_from_map = (turn * tip).toRotationMatrix();
  const Vec3 shift(0.15 * uniform(bits), 0.15 * uniform(bits), 0.3 * uniform(bits));
  const double pixel_mm = 1.32 / static_cast<double>(points);
  FacetMap map{"map.txt", {points, points, 1e3 * pixel_mm, 1e3 * pixel_mm, {}}, {0.0, 0.0}, 0.0};
  for (std::size_t row = 0; row < points; ++row)
    for (std::size_t column = 0; column < points; ++column) {
      const double x = pixel_mm * (static_cast<double>(column) - 0.5 * static_cast<double>(points - 1));
      const double y = pixel_mm * (static_cast<double>(row) - 0.5 * static_cast<double>(points - 1));
      // The height at which the line of sight meets the part: it stands askew on it.
      double z = -shift.z();
      for (int step = 0; step < 60; ++step) {
        const Vec3 p = part_from_map * Vec3(x, y, z) + shift;
        z += 0.5 * (surface.z(p.x(), p.y()) - p.z());
      }
      map.heights.heights_nm.push_back(1e6 * z + 5.0 * normal(bits));
    }
  return map;
}

/// Every interval of 95 % of what is told, over machines with hidden errors of 1 um and 0.02 degrees.
TEST(Correction, IntervalsHoldWhatIsHidden) {
  constexpr std::uint32_t kMachines = 25;
  std::size_t within = 0;
  std::size_t all = 0;
  for (std::uint32_t seed = 1; seed <= kMachines; ++seed) {
    std::mt19937 bits(seed);
    const std::vector<double> hidden = hidden_errors(bits);
    const Correction found = correct(plan(), {seen(CutSurface(with_errors(plan().machine, hidden)), bits)});
    for (std::size_t k = 0; k < hidden.size(); ++k) {
      const CalibratedQuantity& q = found.calibration.quantities[k];
      if (!q.is_told) continue;
      ++all;
      const bool holds = std::abs(q.value - hidden[k]) < 1.96 * q.uncertainty;
      within += holds ? 1 : 0;
    }
  }
  ASSERT_GE(all, 2U * kMachines);
  const double share = static_cast<double>(within) / static_cast<double>(all);
  EXPECT_GE(share, 0.90);
  EXPECT_LE(share, 0.99);
}

/// Where facets end up after programs for the corrected machine, as the verifier cuts them on the real one.
TEST(Correction, TheSecondPartIsAsPromised) {
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    std::mt19937 bits(seed);
    const Machine real = with_errors(plan().machine, hidden_errors(bits));
    const Correction found = correct(plan(), {seen(CutSurface(real), bits)});
    FabricationResult second = plan();
    second.machine = found.calibration.machine;
    second.plan = make_plan(second.job, second.machine);
    // Angles of grooves: what a part that lies askew does not change.
    const auto largest_apex_error = [&](const FabricationResult& made) {
      const Verification v = verify_programs(made.job, real, programs_of(made), {}, {});
      double most = 0.0;
      for (const ElementResult& element : v.elements)
        most = std::max(
            most, kArcsecPerRad * std::abs(element.figures.facets[0].slope_up + element.figures.facets[1].slope_up));
      return most;
    };
    EXPECT_LT(largest_apex_error(second), std::max(0.05 * largest_apex_error(plan()), 2.0 * found.after.tilt_arcsec))
        << seed;
  }
}

/// 300 points of 90,000 are as many as rows: a fixed step would see one column.
TEST(Correction, MapsOfAnySizeAreRegistered) {
  for (const std::size_t points : {120U, 300U}) {
    std::mt19937 bits(7);
    const RegisteredMap map = registered(seen(CutSurface(plan().machine), bits, points), designed_grooves(plan().job));
    EXPECT_EQ(map.figures.size(), 24U) << points;
    EXPECT_LT(map.rms_nm, 6.0) << points;
  }
}

TEST(Correction, RefusesMapsOfOtherParts) {
  std::mt19937 bits(1);
  FacetMap map = seen(CutSurface(plan().machine), bits);
  const auto refused = [](const FacetMap& given) -> std::string {
    try {
      correct(plan(), {given});
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  FacetMap rough = map;
  std::normal_distribution<double> normal;
  for (double& nm : rough.heights.heights_nm) nm = 5e4 * normal(bits);
  EXPECT_TRUE(refused(rough).starts_with("map.txt: lies nowhere on the part")) << refused(rough);
  FacetMap flat = map;
  std::fill(flat.heights.heights_nm.begin(), flat.heights.heights_nm.end(), 0.0);
  EXPECT_NE(refused(flat), "accepted");
  FacetMap empty = map;
  std::fill(empty.heights.heights_nm.begin(), empty.heights.heights_nm.end(), surface_models::kMissing);
  EXPECT_TRUE(refused(empty).starts_with("map.txt: must have at least 90 points")) << refused(empty);
}

}  // namespace
}  // namespace retrace::studies::correction_test
