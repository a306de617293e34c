// Tests of the interference between cells against Fourier sums over many periods with random errors, and of the limits:
// large spreads, wide gaps, power, symmetry.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "raytrace/observers/far_field.h"
#include "raytrace/observers/lattice_field.h"
#include "tests/support/closed_forms.h"
#include "tests/support/designs.h"

namespace retrace::testing::lattice_field_test {
namespace {

using namespace geometry;
using namespace raytrace;
using std::numbers::pi;
using Complex = std::complex<double>;

constexpr double kWaveNm = 550.0;
constexpr double kWave = 1e-6 * kWaveNm;
constexpr double kWaveNumber = 2.0 * pi / kWave;
constexpr double kThickness = 0.3;

struct Spread {
  double depth_nm = 0.0, spacing_nm = 0.0;
};

FarFieldPolicy policy_of(const std::optional<Spread>& spread, double wavelength_nm = kWaveNm) {
  FarFieldPolicy policy;
  policy.wavelength_nm = wavelength_nm;
  policy.window_rad = 0.1;
  if (spread) policy.interference = CellInterference{1e-6 * spread->depth_nm, 1e-6 * spread->spacing_nm, kPmma, {}};
  return policy;
}

FarField field_of(const PartSpec& spec, const Optics& optics, const Illumination& light, const FarFieldPolicy& policy) {
  const Part part = build_part(spec);
  FarFieldCollector collector(part, light, policy);
  BeamPolicy beams;
  beams.cutoff = 1e-6;
  beams.separate_cells = true;
  BeamTracer(part, BeamTracer::Elements::instanced)
      .trace(optics, light, {0.5}, beams, nullptr, [&](const ReturnedBeam& b) { collector.add(b); });
  return collector.finish();
}

ApertureKernel discs(double source_arcmin, double receiver_arcmin) {
  return ApertureKernel({Angle::from_deg(source_arcmin / 60.0), Angle::from_deg(receiver_arcmin / 60.0)});
}

Vec3 direction_at(const Vec2& cosines) {
  return {cosines.x(), cosines.y(), std::sqrt(1.0 - cosines.squaredNorm())};
}

/// Transforms in place: sum of a[j] exp(-2 pi i j k / n) for a power of two.
void transform(std::vector<Complex>& a) {
  const std::size_t n = a.size();
  for (std::size_t i = 1, j = 0; i < n; ++i) {
    std::size_t bit = n >> 1;
    for (; j & bit; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) std::swap(a[i], a[j]);
  }
  for (std::size_t half = 1; half < n; half *= 2)
    for (std::size_t k = 0; k < half; ++k) {
      const Complex w = std::polar(1.0, -pi * static_cast<double>(k) / static_cast<double>(half));
      for (std::size_t i = k; i < n; i += 2 * half) {
        const Complex t = w * a[i + half];
        a[i + half] = a[i] - t;
        a[i] += t;
      }
    }
}

using FieldOfDirection = std::function<Complex(const Vec2&)>;

Complex uniform(const Vec2&) {
  return 1.0;
}

/// A kind of cell of the reference: its position in the period, and the Fourier integral of its field over its
/// aperture. The integral is a product of two factors. Along axes that the cell reverses, the pattern moves with the
/// source, and the argument is the direction of the observer minus that of the source. Along the roof edge of a prism,
/// the pattern moves against the source, and the argument is the sum of both directions.
struct ReferenceCell {
  Vec2 position_mm;
  FieldOfDirection of_difference;
  FieldOfDirection of_sum = uniform;
};

/// Array of the reference. The period is the parallelogram of two vectors.
struct ReferenceArray {
  Vec2 first_mm, second_mm;
  std::vector<ReferenceCell> cells;
  double area_mm2() const { return std::abs(first_mm.x() * second_mm.y() - first_mm.y() * second_mm.x()); }
};

/// Intensity of many periods, by fast Fourier transforms of the cells' phases. Each cell has a random depth and a
/// random displacement. The amplitude of the light falls to 0 at the border of the patch (Hann window), so that orders
/// have no side lobes.
class ManyPeriods {
 public:
  static constexpr std::size_t kPeriods = 48, kPoints = 128;

  /// \param sum_mid direction cosines of the observer plus those of the source, for the phases of displacements
  ManyPeriods(const ReferenceArray& array, const Spread& spread, const Vec2& sum_mid, int draws) : array_(array) {
    const std::size_t kinds = array.cells.size();
    products_.assign(kinds * kinds, std::vector<Complex>(kPoints * kPoints, 0.0));
    std::mt19937_64 random(11);
    std::normal_distribution<double> normal;
    double weights = 0.0;
    for (std::size_t i = 0; i < kPeriods; ++i) weights += hann(i) * hann(i);
    for (int draw = 0; draw < draws; ++draw) {
      std::vector<std::vector<Complex>> sums;
      for (std::size_t kind = 0; kind < kinds; ++kind) {
        std::vector<Complex> grid(kPoints * kPoints, 0.0);
        for (std::size_t i = 0; i < kPeriods; ++i)
          for (std::size_t j = 0; j < kPeriods; ++j) {
            const double depth_mm = 1e-6 * spread.depth_nm * normal(random);
            const Vec2 moved_mm = 1e-6 * spread.spacing_nm * Vec2(normal(random), normal(random));
            const double cosine = std::sqrt(1.0 - 0.25 * sum_mid.squaredNorm() / (kPmma * kPmma));
            const double phase = kWaveNumber * (2.0 * kPmma * cosine * depth_mm - sum_mid.dot(moved_mm));
            grid[i * kPoints + j] = std::polar(hann(i) * hann(j), phase);
          }
        transform_plane(grid);
        sums.push_back(std::move(grid));
      }
      for (std::size_t a = 0; a < kinds; ++a)
        for (std::size_t b = 0; b < kinds; ++b)
          for (std::size_t k = 0; k < kPoints * kPoints; ++k)
            products_[a * kinds + b][k] += sums[a][k] * std::conj(sums[b][k]) / (draws * weights * weights);
    }
  }

  /// Returns the power per unit area of direction cosines, averaged over the discs of source and receiver.
  /// \param cosines_per_rad derivatives of the direction cosines with respect to the angles of the discs
  double reading(const Vec2& source, const Vec2& observer, double source_rad, double receiver_rad,
                 const Eigen::Matrix2d& cosines_per_rad = Eigen::Matrix2d::Identity()) const {
    constexpr int kHalf = 36;
    const double reach = source_rad + receiver_rad;
    const double step = reach / kHalf;
    const std::size_t kinds = array_.cells.size();
    // Fields at the differences d = r - delta of the displacements of receiver and source.
    std::vector<Vec2> differences;
    std::vector<std::vector<Complex>> fields(kinds);
    for (int i = -kHalf; i <= kHalf; ++i)
      for (int j = -kHalf; j <= kHalf; ++j) {
        differences.push_back(step * Vec2(i, j));
        const Vec2 cosines = cosines_per_rad * differences.back();
        for (std::size_t kind = 0; kind < kinds; ++kind)
          fields[kind].push_back(array_.cells[kind].of_difference(observer - source + cosines));
      }
    const double discs_area = pi * source_rad * source_rad * pi * receiver_rad * receiver_rad;
    const Vec2 middle(array_.first_mm.dot(observer + source) / kWave, array_.second_mm.dot(observer + source) / kWave);
    const Vec2 range = reach / kWave * Vec2(array_.first_mm.norm(), array_.second_mm.norm());
    const double points = static_cast<double>(kPoints);
    Eigen::Matrix2d rows;
    rows << array_.first_mm.transpose(), array_.second_mm.transpose();
    const Eigen::Matrix2d inverse = rows.inverse(), rad_per_cosine = cosines_per_rad.inverse();
    double sum = 0.0;
    const auto bound = [&](double value) { return static_cast<long>(std::floor(value * points)); };
    for (long m = bound(middle.x() - range.x()); m <= bound(middle.x() + range.x()) + 1; ++m)
      for (long n = bound(middle.y() - range.y()); n <= bound(middle.y() + range.y()) + 1; ++n) {
        const Vec2 x = Vec2(static_cast<double>(m), static_cast<double>(n)) / points;
        const Vec2 total = kWave * (inverse * x);  // direction cosines of observer and source together
        const Vec2 p = rad_per_cosine * (total - observer - source);
        if (p.norm() > reach) continue;
        const auto wrapped = [](long k) {
          const long size = static_cast<long>(kPoints);
          return static_cast<std::size_t>(((k % size) + size) % size);
        };
        const std::size_t at = wrapped(m) * kPoints + wrapped(n);
        if (std::abs(products_.front()[at]) < 1e-7) continue;
        std::vector<Complex> moments(kinds * kinds, 0.0);
        for (std::size_t k = 0; k < differences.size(); ++k) {
          const Vec2& d = differences[k];
          if ((p + d).squaredNorm() > 4.0 * receiver_rad * receiver_rad ||
              (p - d).squaredNorm() > 4.0 * source_rad * source_rad)
            continue;
          for (std::size_t a = 0; a < kinds; ++a)
            for (std::size_t b = 0; b < kinds; ++b) moments[a * kinds + b] += fields[a][k] * std::conj(fields[b][k]);
        }
        for (std::size_t a = 0; a < kinds; ++a)
          for (std::size_t b = 0; b < kinds; ++b) {
            const Complex shift =
                std::polar(1.0, -kWaveNumber * total.dot(array_.cells[a].position_mm - array_.cells[b].position_mm));
            sum += (products_[a * kinds + b][at] * shift * moments[a * kinds + b] * array_.cells[a].of_sum(total) *
                    std::conj(array_.cells[b].of_sum(total)))
                       .real();
          }
      }
    const double per_point = rad_per_cosine.determinant() * kWave * kWave / (array_.area_mm2() * points * points);
    return 0.25 * sum * step * step * per_point / discs_area / (kWave * kWave * array_.area_mm2());
  }

 private:
  static double hann(std::size_t i) {
    const double s = std::sin(pi * (static_cast<double>(i) + 0.5) / static_cast<double>(kPeriods));
    return s * s;
  }
  static void transform_plane(std::vector<Complex>& grid) {
    std::vector<Complex> line(kPoints);
    for (std::size_t i = 0; i < kPoints; ++i) {
      std::copy_n(grid.begin() + static_cast<std::ptrdiff_t>(i * kPoints), kPoints, line.begin());
      transform(line);
      std::copy_n(line.begin(), kPoints, grid.begin() + static_cast<std::ptrdiff_t>(i * kPoints));
    }
    for (std::size_t j = 0; j < kPoints; ++j) {
      for (std::size_t i = 0; i < kPoints; ++i) line[i] = grid[i * kPoints + j];
      transform(line);
      for (std::size_t i = 0; i < kPoints; ++i) grid[i * kPoints + j] = line[i];
    }
  }

  ReferenceArray array_;
  std::vector<std::vector<Complex>> products_;  ///< means of products of the sums of two kinds of cells
};

double sinc(double x) {
  return std::abs(x) < 1e-9 ? 1.0 : std::sin(x) / x;
}

/// Returns the Fourier integral of a plane wave through a rectangle. The phase of the wave is 0 at the origin.
Complex rectangle(const Vec2& centre_mm, const Vec2& size_mm, const Vec2& wave, const Vec2& u) {
  const Vec2 kappa = kWaveNumber * (u - wave);
  return size_mm.prod() * sinc(0.5 * kappa.x() * size_mm.x()) * sinc(0.5 * kappa.y() * size_mm.y()) *
         std::polar(1.0, -kappa.dot(centre_mm));
}

/// Returns the direction cosine with which light that falls vertically on the left facet of a prism returns, for mirror
/// facets that meet at 90 degrees plus an error.
double cosine_from_left(double error_rad) {
  const double a = 0.25 * pi - 0.5 * error_rad;
  Vec2 d(0.0, -1.0);
  for (const Vec2& normal : {Vec2(std::sin(a), std::cos(a)), Vec2(-std::sin(a), std::cos(a))})
    d -= 2.0 * normal.dot(d) * normal;
  return kPmma * d.x();
}

/// Returns a prism whose root is at a point. Light from the left facet leaves on the right.
ReferenceCell prism(const Vec2& root_mm, double base_mm, double width_mm, double error_rad) {
  const double tilt = cosine_from_left(error_rad);
  const auto across = [=](const Vec2& u) {
    const Vec2 size(0.5 * base_mm, 1.0), at(u.x(), 0.0);
    return rectangle({0.25 * base_mm, 0.0}, size, {tilt, 0.0}, at) +
           rectangle({-0.25 * base_mm, 0.0}, size, {-tilt, 0.0}, at);
  };
  const auto along = [=](const Vec2& u) { return rectangle({0.0, 0.0}, {1.0, width_mm}, {0.0, 0.0}, {0.0, u.y()}); };
  return {root_mm, across, along};
}

/// Returns a prism that is rotated by 90 degrees. Two mirrors rotate a field by 180 degrees about the roof edge. The
/// field of a rotated prism therefore has the opposite sign for both polarisations.
ReferenceCell rotated_prism(const Vec2& root_mm, double base_mm, double error_rad) {
  const ReferenceCell straight = prism(root_mm, base_mm, base_mm, error_rad);
  return {root_mm,
          [=](const Vec2& u) {
            return -straight.of_difference({u.y(), -u.x()});
          },
          [=](const Vec2& u) {
            return straight.of_sum({u.y(), -u.x()});
          }};
}

/// Returns the field of a uniform hexagon with two vertical sides.
FieldOfDirection upright_hexagon(double inradius_mm) {
  return [=](const Vec2& u) {
    constexpr int kStrips = 200;
    const double radius = inradius_mm / std::cos(pi / 6.0);
    const double step = 2.0 * radius / kStrips;
    Complex sum = 0.0;
    for (int k = 0; k < kStrips; ++k) {
      const double y = (k + 0.5) * step - radius;
      const double half = std::min(inradius_mm, (radius - std::abs(y)) * std::sqrt(3.0));
      sum += step * 2.0 * half * sinc(kWaveNumber * u.x() * half) * std::polar(1.0, -kWaveNumber * u.y() * y);
    }
    return sum;
  };
}

struct Case {
  std::string name;
  PartSpec spec;
  ReferenceArray reference;
};

std::vector<Case> cases() {
  const double error = 4.0 / 60.0;
  const double error_rad = error * kDeg;
  constexpr double kBase = 0.1, kWidth = 0.13, kGap = 0.02;
  std::vector<Case> all;
  PartSpec rows = infinite(RtpElement{kBase, kWidth, 90.0 + error}, Arrangement::aligned, kThickness);
  all.push_back({"rows", rows, {{kBase, 0.0}, {0.0, kWidth}, {prism({0.0, 0.0}, kBase, kWidth, error_rad)}}});
  PartSpec gaps = rows;
  gaps.array.x_gap_mm = kGap;
  all.push_back({"gaps", gaps, {{kBase + kGap, 0.0}, {0.0, kWidth}, {prism({0.0, 0.0}, kBase, kWidth, error_rad)}}});
  const PartSpec bricks = infinite(RtpElement{kBase, kWidth, 90.0 + error}, Arrangement::offset, kThickness);
  all.push_back(
      {"bricks",
       bricks,
       {{kBase, 0.0},
        {0.0, 2.0 * kWidth},
        {prism({0.0, 0.0}, kBase, kWidth, error_rad), prism({0.5 * kBase, kWidth}, kBase, kWidth, error_rad)}}});
  const PartSpec checker = infinite(RtpElement{kBase, kBase, 90.0 + error}, Arrangement::checker, kThickness);
  all.push_back({"checker",
                 checker,
                 {{kBase, kBase},
                  {kBase, -kBase},
                  {prism({0.0, 0.0}, kBase, kBase, error_rad), rotated_prism({kBase, 0.0}, kBase, error_rad)}}});
  constexpr double kAperture = 0.16, kRadius = 0.5 * kAperture;
  const Vec2 first(1.5 * kRadius, 0.5 * std::sqrt(3.0) * kRadius), second(first.x(), -first.y());
  all.push_back({"triangles",
                 infinite(TriangularCube{kAperture}, Arrangement::triangular, kThickness),
                 {first,
                  second,
                  {{{0.0, 0.0}, upright_hexagon(0.5 * kRadius)}, {{-kRadius, 0.0}, upright_hexagon(0.5 * kRadius)}}}});
  return all;
}

}  // namespace

// Prisms in several arrangements and triangular cube corners at normal incidence, with random depths. The discs have
// different diameters, because the power of an order depends on the position of the source.
TEST(LatticeField, AgreesWithFourierSumsOverManyPeriods) {
  for (const Case& c : cases())
    for (const double depth_nm : {0.0, 25.0}) {
      const Spread spread{depth_nm, 0.0};
      const FarField field = field_of(c.spec, ideal(), {}, policy_of(spread));
      const ManyPeriods reference(c.reference, spread, Vec2::Zero(), depth_nm > 0.0 ? 200 : 1);
      struct Reading {
        double found, expected;
      };
      std::vector<Reading> readings;
      double peak = 0.0;
      for (const Vec2& observer :
           {Vec2(0.0, 0.0), Vec2(1.2e-3, 0.0), Vec2(3.1e-3, 1.0e-3), Vec2(2.75e-3, 2.75e-3), Vec2(2.0e-3, 4.0e-3)}) {
        const ApertureKernel kernel = discs(10.0, 6.0);
        readings.push_back(
            {field.intensity(direction_at(observer), kernel).per_sr,
             reference.reading(Vec2::Zero(), observer, kernel.source_radius_rad(), kernel.receiver_radius_rad())});
        peak = std::max(peak, readings.back().expected);
      }
      for (std::size_t k = 0; k < readings.size(); ++k)
        EXPECT_NEAR(readings[k].found, readings[k].expected, 0.01 * peak) << c.name << " " << depth_nm << " nm " << k;
    }
}

// Cube corners at oblique incidence with total reflection and angle errors. Displacements of cells change the phase.
// The pattern of a single cell is the far field without interference between cells.
TEST(LatticeField, AgreesWithRandomDisplacementsAtObliqueIncidence) {
  constexpr double kAperture = 0.12, kRadius = 0.5 * kAperture;
  PartSpec spec = infinite(HexagonalCube{kAperture}, Arrangement::honeycomb, kThickness);
  spec.angle_errors.dihedral_error_arcmin = {3.0, 3.0, 3.0};
  Optics optics = pmma();
  optics.lossless_entrance = true;
  const Illumination light = from(12.0, 25.0);
  const Vec2 source = std::sin(12.0 * kDeg) * Vec2(std::cos(25.0 * kDeg), std::sin(25.0 * kDeg));
  const FarField cells = field_of(spec, optics, light, policy_of(std::nullopt));
  ReferenceArray array{
      {1.5 * kRadius, 0.5 * std::sqrt(3.0) * kRadius}, {1.5 * kRadius, -0.5 * std::sqrt(3.0) * kRadius}, {}};
  const double area_mm2 = array.area_mm2();
  array.cells.push_back({Vec2::Zero(), [&](const Vec2& u) {
                           const Vec3 at = direction_at(source + u);
                           return Complex(kWave * std::sqrt(area_mm2 * cells.diffracted_per_sr(at) / at.z()), 0.0);
                         }});
  for (const Spread spread : {Spread{0.0, 0.0}, Spread{0.0, 120.0}, Spread{25.0, 60.0}}) {
    const FarField field = field_of(spec, optics, light, policy_of(spread));
    const ManyPeriods reference(array, spread, 2.0 * source, 100);
    const ApertureKernel kernel = discs(10.0, 10.0);
    std::vector<double> found, expected;
    for (const Vec2& away : {Vec2(0.0, 0.0), Vec2(1.5e-3, 0.5e-3), Vec2(0.0, 4.0e-3), Vec2(-3.0e-3, 1.0e-3)}) {
      const Vec3 direction = direction_at(source + away);
      found.push_back(field.intensity(direction, kernel).per_sr);
      Eigen::Matrix2d cosines_per_rad;
      const Vec3 right = direction.cross(Vec3::UnitX()).normalized();
      cosines_per_rad << right.head<2>(), direction.cross(right).head<2>();
      expected.push_back(direction.z() * reference.reading(source, source + away, kernel.source_radius_rad(),
                                                           kernel.receiver_radius_rad(), cosines_per_rad));
    }
    const double peak = *std::max_element(expected.begin(), expected.end());
    for (std::size_t k = 0; k < found.size(); ++k)
      EXPECT_NEAR(found[k], expected[k], 0.01 * peak) << spread.depth_nm << " " << spread.spacing_nm << " " << k;
  }
}

// With a large spread of depths, cells do not interfere. The readings are those of summed intensities.
TEST(LatticeField, LargeSpreadAddsIntensities) {
  const ApertureKernel kernel = discs(10.0, 10.0);
  for (const Case& c : cases()) {
    const FarField sum = field_of(c.spec, pmma(), from(5.0), policy_of(std::nullopt));
    const FarField spread = field_of(c.spec, pmma(), from(5.0), policy_of(Spread{1000.0, 0.0}));
    for (const double x : {0.0, 2e-3, 6e-3}) {
      const Vec3 at = direction_at({std::sin(5.0 * kDeg) + x, 1e-3});
      const double expected = sum.intensity(at, kernel).per_sr;
      EXPECT_NEAR(spread.intensity(at, kernel).per_sr, expected, 1e-9 * expected) << c.name << " " << x;
    }
  }
}

// The reading is the coherent fraction of that of the perfect array plus the diffuse remainder.
TEST(LatticeField, SpreadInterpolatesBetweenBothSums) {
  const ApertureKernel kernel = discs(10.0, 4.0);
  const PartSpec spec = cases().front().spec;
  const double cells =
      field_of(spec, ideal(), {}, policy_of(std::nullopt)).intensity(direction_at({2e-3, 0.0}), kernel).per_sr;
  const double array =
      field_of(spec, ideal(), {}, policy_of(Spread{})).intensity(direction_at({2e-3, 0.0}), kernel).per_sr;
  EXPECT_GT(std::abs(array - cells), 0.1 * cells);
  for (const double depth_nm : {1.0, 10.0, 30.0, 60.0}) {
    const double phase = kWaveNumber * 2.0 * kPmma * 1e-6 * depth_nm;
    const double coherent = std::exp(-phase * phase);
    const double found = field_of(spec, ideal(), {}, policy_of(Spread{depth_nm, 0.0}))
                             .intensity(direction_at({2e-3, 0.0}), kernel)
                             .per_sr;
    EXPECT_NEAR(found, coherent * array + (1.0 - coherent) * cells, 1e-4 * cells) << depth_nm;
  }
}

// Cells that are far apart fill the discs with orders. The sum over the orders is then the pattern of a single cell.
TEST(LatticeField, WideGapsShowTheSingleCell) {
  PartSpec spec = cases().front().spec;
  spec.array.x_gap_mm = spec.array.y_gap_mm = 1.5;
  const ApertureKernel kernel = discs(10.0, 10.0);
  Optics optics = ideal();
  optics.back_index = optics.index;  // the land between the prisms does not reflect light
  const FarField cells = field_of(spec, optics, {}, policy_of(std::nullopt));
  const FarField array = field_of(spec, optics, {}, policy_of(Spread{}));
  const double peak = cells.intensity(Vec3::UnitZ(), kernel).per_sr;
  for (const double x : {0.0, 1.7e-3, 4e-3}) {
    const Vec3 at = direction_at({x, 0.4e-3});
    EXPECT_NEAR(array.intensity(at, kernel).per_sr, cells.intensity(at, kernel).per_sr, 5e-3 * peak) << x;
  }
}

// The orders of a perfect array and the diffuse light of a real one carry the power of the beams.
TEST(LatticeField, ConservesPower) {
  for (const Case& c : cases())
    for (const double depth_nm : {0.0, 30.0}) {
      const FarField field = field_of(c.spec, pmma(), from(8.0), policy_of(Spread{depth_nm, 20.0}));
      ReturnFrame frame;
      frame.to_source = direction_at({std::sin(8.0 * kDeg), 0.0});
      frame.right = Vec3::UnitY();
      frame.up = frame.to_source.cross(frame.right);
      const FarField::Split split = field.split(frame, 0.02);
      EXPECT_NEAR(split.inside + split.outside, field.total_power(), 1e-3 * field.total_power())
          << c.name << " " << depth_nm;
      EXPECT_GT(split.inside, 0.5 * field.diffracted_power()) << c.name;
      EXPECT_GT(field.diffracted_power(), 0.0) << c.name;
    }
}

// The bins of a map contain the power of the orders.
TEST(LatticeField, MapContainsTheOrders) {
  const FarField field = field_of(cases().front().spec, ideal(), {}, policy_of(Spread{}));
  const DirectionGrid grid(DirectionGrid::Layout::square, 0.03, 61, 61);
  const std::vector<double> bins = field.binned({}, grid);
  double sum = 0.0;
  for (std::size_t k = 0; k < grid.size(); ++k) sum += bins[k];
  EXPECT_NEAR(sum + bins.back(), field.total_power(), 1e-3);
  // The orders of the rows are 5.5 mrad apart along x and 4.2 mrad along y. Bins are 1 mrad wide.
  int lit = 0;
  for (std::size_t k = 0; k < grid.size(); ++k) lit += bins[k] > 1e-9 ? 1 : 0;
  EXPECT_LE(lit, 11 * 15);
  EXPECT_GT(sum, 0.9 * field.total_power());
}

// Arrays with mirror symmetry return equal intensities in mirrored directions.
TEST(LatticeField, IsSymmetric) {
  const ApertureKernel kernel = discs(10.0, 5.0);
  const FarField field = field_of(cases()[3].spec, pmma(), {}, policy_of(Spread{10.0, 0.0}));
  for (const Vec2& at : {Vec2(1e-3, 2e-3), Vec2(4e-3, 1.5e-3)}) {
    const double here = field.intensity(direction_at(at), kernel).per_sr;
    EXPECT_NEAR(field.intensity(direction_at({-at.x(), at.y()}), kernel).per_sr, here, 2e-3 * here);
    EXPECT_NEAR(field.intensity(direction_at({at.x(), -at.y()}), kernel).per_sr, here, 2e-3 * here);
  }
}

// The reading over a band of wavelengths is the mean of the readings at many single wavelengths.
TEST(LatticeField, BandBlursOrders) {
  const PartSpec spec = cases().front().spec;
  const Illumination light = from(10.0);
  const ApertureKernel kernel = discs(10.0, 10.0);
  const Vec3 at = direction_at({std::sin(10.0 * kDeg) + 1.5e-3, 0.5e-3});
  FarFieldPolicy policy = policy_of(Spread{});
  policy.interference->band_nm = {530.0, 550.0, 570.0};
  const double band = field_of(spec, ideal(), light, policy).intensity(at, kernel).per_sr;
  constexpr int kLines = 60;
  double mean = 0.0, least = 1e300, most = 0.0;
  for (int k = 0; k < kLines; ++k) {
    const double wavelength_nm = 530.0 + 40.0 * (k + 0.5) / kLines;
    const double line = field_of(spec, ideal(), light, policy_of(Spread{}, wavelength_nm)).intensity(at, kernel).per_sr;
    mean += line / kLines;
    least = std::min(least, line);
    most = std::max(most, line);
  }
  EXPECT_NEAR(band, mean, 0.01 * mean);
  EXPECT_GT(most, 2.0 * least);
}

// A point source or a point receiver is the limit of a small disc.
TEST(LatticeField, PointsAreSmallDiscs) {
  const FarField field = field_of(cases().front().spec, ideal(), {}, policy_of(Spread{}));
  const Vec3 at = direction_at({0.6e-3, 0.0});
  const double source = field.intensity(at, discs(10.0, 0.0)).per_sr;
  EXPECT_NEAR(source, field.intensity(at, discs(10.0, 0.01)).per_sr, 2e-3 * source);
  const double receiver = field.intensity(at, discs(0.0, 10.0)).per_sr;
  EXPECT_NEAR(receiver, field.intensity(at, discs(0.01, 10.0)).per_sr, 2e-3 * receiver);
  EXPECT_GT(std::abs(source - receiver), 1e-3 * source);
}

}  // namespace retrace::testing::lattice_field_test
