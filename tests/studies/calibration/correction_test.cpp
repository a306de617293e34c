#include "studies/calibration/correction.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

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

constexpr std::uint32_t kMachines = 200;

/// Four prisms with land of 0.25 mm between them.
const FabricationResult& plan() {
  static const FabricationResult made = test::planned(test::prism_job({90.0, 0.25, 10.0, 1}));
  return made;
}

/// The planes that the verifier finds of a part's facets, and the face, as a surface over the plane.
class CutSurface {
 public:
  explicit CutSurface(const Machine& real, const FabricationResult& made = plan())
      : grooves_(designed_grooves(made.job)), figures_(cut_on(real, made)) {
    for (std::size_t element = 0; element < grooves_.size(); ++element)
      for (std::size_t facet = 0; facet < 2; ++facet) {
        const FacetFigures& f = figures_[2 * element + facet];
        const DesignFacet& design = grooves_[element].facets[facet];
        const Vec3 along = grooves_[element].level_of(facet);
        const Vec3 point = grooves_[element].root_mm + f.mean_up_mm * design.up_slope + f.mean_along_mm * along +
                           1e-6 * f.mean_nm * design.normal;
        const Vec3 normal = (design.normal - f.slope_up * design.up_slope - f.slope_along * along).normalized();
        planes_.emplace_back(normal, point);
      }
  }

  double z(double x, double y) const {
    const Vec3 p(x, y, 0.0);
    for (std::size_t element = 0; element < grooves_.size(); ++element) {
      const Groove& groove = grooves_[element];
      const double along = groove.along_mm(p);
      const double across =
          groove.root_direction.x() * (y - groove.root_mm.y()) - groove.root_direction.y() * (x - groove.root_mm.x());
      if (std::abs(along) > groove.half_width_mm || std::abs(across) > groove.half_base_mm) continue;
      double z = -1e9;
      for (const auto& [normal, point] : {planes_[2 * element], planes_[2 * element + 1]})
        z = std::max(z, point.z() - (normal.x() * (x - point.x()) + normal.y() * (y - point.y())) / normal.z());
      return std::min(z, 0.0);
    }
    return 0.0;
  }

  /// How far facets are off at most, but for what any part does that lies turned or shifted: that is not told.
  FacetOutlook off() const {
    constexpr double kTiltNm = 250.0;  // weighs a turn as what it does over half a facet
    const auto facets = static_cast<Eigen::Index>(planes_.size());
    Eigen::MatrixXd of_pose(3 * facets, 5);
    Eigen::VectorXd off(3 * facets);
    for (Eigen::Index k = 0; k < facets; ++k) {
      const FacetFigures& f = figures_[static_cast<std::size_t>(k)];
      const Groove& groove = grooves_[static_cast<std::size_t>(k / 2)];
      const DesignFacet& design = groove.facets[static_cast<std::size_t>(k % 2)];
      const Vec3 along = groove.level_of(static_cast<std::size_t>(k % 2));
      const Vec3 at = groove.root_mm + f.mean_up_mm * design.up_slope + f.mean_along_mm * along;
      const Vec3& n = design.normal;
      of_pose.row(3 * k) << at.cross(n).transpose(), n.x(), n.y();
      of_pose.row(3 * k + 1) << kTiltNm * 1e-6 * design.up_slope.cross(n).transpose(), 0.0, 0.0;
      of_pose.row(3 * k + 2) << kTiltNm * 1e-6 * along.cross(n).transpose(), 0.0, 0.0;
      off.segment<3>(3 * k) << 1e-6 * f.mean_nm, kTiltNm * 1e-6 * f.slope_up, kTiltNm * 1e-6 * f.slope_along;
    }
    const Eigen::VectorXd left = off - of_pose * of_pose.colPivHouseholderQr().solve(off);
    FacetOutlook most;
    for (Eigen::Index k = 0; k < left.size(); ++k)
      if (k % 3 == 0)
        most.distance_nm = std::max(most.distance_nm, 1e6 * std::abs(left[k]));
      else
        most.tilt_arcsec = std::max(most.tilt_arcsec, kArcsecPerRad * 1e6 / kTiltNm * std::abs(left[k]));
    return most;
  }

  /// By how much the angle of a groove is off at most.
  double apex_error_arcsec() const {
    double most = 0.0;
    for (std::size_t k = 0; k < figures_.size(); k += 2)
      most = std::max(most, kArcsecPerRad * std::abs(figures_[k].slope_up + figures_[k + 1].slope_up));
    return most;
  }

 private:
  static std::vector<FacetFigures> cut_on(const Machine& real, const FabricationResult& made) {
    const Verification v = verify_programs(made.job, real, programs_of(made), {}, {});
    std::vector<FacetFigures> figures;
    for (const ElementResult& element : v.elements)
      for (const FacetFigures& facet : element.figures.facets) figures.push_back(facet);
    return figures;
  }

  std::vector<Groove> grooves_;
  std::vector<FacetFigures> figures_;  ///< facet by facet
  std::vector<std::pair<Vec3, Vec3>> planes_;
};

/// What an instrument sees of all of the part, with 5 nm of noise; 220 points a row are 6 um apart.
template <class Surface>
FacetMap seen(const Surface& surface, std::mt19937& bits, std::size_t points = 220) {
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
      // The height at which the line of sight meets the part: it stands askew on it, by so little that each step leaves
      // less than a hundredth of what is missing.
      constexpr int kSteps = 8;
      double z = -shift.z();
      for (int step = 0; step < kSteps; ++step) {
        const Vec3 p = part_from_map * Vec3(x, y, z) + shift;
        const double missing = surface.z(p.x(), p.y()) - p.z();
        z += missing;
        if (std::abs(missing) < 1e-10) break;
      }
      map.heights.heights_nm.push_back(1e6 * z + 5.0 * normal(bits));
    }
  return map;
}

/// A machine with hidden errors of 1 um and 0.02 degrees, and what is found of it.
struct FoundMachine {
  std::vector<double> hidden;
  Machine real;
  CutSurface first;  ///< of the job's programs
  Correction found;
};

/// The same for the same seed, each made once for all tests of this file.
const FoundMachine& found_machine(std::uint32_t seed) {
  static std::map<std::uint32_t, FoundMachine> all;
  if (const auto known = all.find(seed); known != all.end()) return known->second;
  std::mt19937 bits(seed);
  std::vector<double> hidden = hidden_errors(bits);
  Machine real = with_errors(plan().machine, hidden);
  CutSurface first(real);
  Correction found = correct(plan(), {seen(first, bits)});
  found.maps.clear();
  return all.emplace(seed, FoundMachine{std::move(hidden), std::move(real), std::move(first), std::move(found)})
      .first->second;
}

/// Every interval of 95 % of what is told, over 200 machines: of such a share 182 to 198 in 99 of 100 cases.
TEST(Correction, IntervalsHoldWhatIsHidden) {
  std::map<std::string_view, std::size_t> within;
  for (std::uint32_t seed = 1; seed <= kMachines; ++seed) {
    const FoundMachine& machine = found_machine(seed);
    std::vector<std::string_view> told;
    for (std::size_t k = 0; k < machine.hidden.size(); ++k) {
      const CalibratedQuantity& q = machine.found.calibration.quantities[k];
      if (!q.is_told) continue;
      told.push_back(q.quantity->key);
      within[q.quantity->key] += std::abs(q.value - machine.hidden[k]) < 1.96 * q.uncertainty ? 1U : 0U;
    }
    EXPECT_EQ(told, (std::vector<std::string_view>{"c_lean_y_arcsec", "tool_turn_z_arcsec"})) << seed;
  }
  for (const auto& [key, count] : within) {
    EXPECT_GE(count, 182U) << key;
    EXPECT_LE(count, 198U) << key;
  }
}

/// Facets and grooves that programs for the corrected machine leave, as the verifier cuts them on the real one. What is
/// promised is twice the standard uncertainty; an angle of a groove is made of two tilts.
TEST(Correction, TheSecondPartIsAsPromised) {
  constexpr double kLeft = 0.05;
  for (std::uint32_t seed = 1; seed <= kMachines; ++seed) {
    const FoundMachine& machine = found_machine(seed);
    FabricationResult second = plan();
    second.machine = machine.found.calibration.machine;
    second.plan = make_plan(second.job, second.machine);
    const CutSurface cut(machine.real, second);
    const FacetOutlook before = machine.first.off();
    const FacetOutlook now = cut.off();
    const FacetOutlook& promised = machine.found.after;
    EXPECT_LT(now.distance_nm, std::max(kLeft * before.distance_nm, promised.distance_nm)) << seed;
    EXPECT_LT(now.tilt_arcsec, std::max(kLeft * before.tilt_arcsec, promised.tilt_arcsec)) << seed;
    EXPECT_LT(cut.apex_error_arcsec(), std::max(kLeft * machine.first.apex_error_arcsec(), 2.0 * promised.tilt_arcsec))
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
