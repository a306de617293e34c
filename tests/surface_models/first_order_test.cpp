// Tests of first-order scattering by roughness between dielectrics. The reference is the independent Rayleigh method
// for shallow gratings. Energy, reciprocity, limits and sampling are also tested.
#include <Eigen/Dense>

#include "materials/fresnel.h"
#include "tests/surface_models/scatter_checks.h"

namespace retrace::testing::first_order_test {
namespace {

using namespace scatter_checks;
using Complex = std::complex<double>;
using Eigen::Vector3cd;

/// Returns the cross product. Eigen's own function returns the complex conjugate for complex vectors.
Vector3cd cross(const Vector3cd& a, const Vector3cd& b) {
  return {a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(), a.x() * b.y() - a.y() * b.x()};
}

/// A sinusoidal grating h = depth cos(g x) between two media, solved by the Rayleigh method. Plane waves of all orders
/// are assumed on both sides, down to the bottom of the grooves, and their fields are matched on the surface. The
/// method is exact as the depth goes to 0. Lengths are in units of w / (2 pi), and the time dependence is exp(-i w t).
template <int kOrders>
class GratingOf {
 public:
  static constexpr int kCount = 2 * kOrders + 1;

  /// \param k wave vector of the incident light along the mean plane
  GratingOf(double index_from, double index_to, const Vec2& k, double g, double depth)
      : index_{index_from, index_to}, k_(k), g_(g) {
    constexpr int kPoints = 48;
    constexpr int kUnknowns = 4 * kCount;
    Eigen::MatrixXcd system = Eigen::MatrixXcd::Zero(kUnknowns, kUnknowns);
    Eigen::MatrixXcd right = Eigen::MatrixXcd::Zero(kUnknowns, 2);
    for (int n = 0; n < kPoints; ++n) {
      const double x = 2.0 * std::numbers::pi * n / kPoints;  // g x
      const double h = depth * std::cos(x), slope = -depth * g * std::sin(x);
      const auto along = [&](const Vector3cd& e, const Vector3cd& wave, int row) {
        const Vector3cd magnetic = cross(wave, e);
        const std::array<Complex, 4> all = {e.x() + slope * e.z(), e.y(), magnetic.x() + slope * magnetic.z(),
                                            magnetic.y()};
        return all[static_cast<std::size_t>(row)];
      };
      for (int m = -kOrders; m <= kOrders; ++m)
        for (int row = 0; row < 4; ++row) {
          const int equation = 4 * (m + kOrders) + row;
          for (int p = -kOrders; p <= kOrders; ++p)
            for (int medium : {0, 1})
              for (int pol : {0, 1}) {
                const Vector3cd wave = wave_vector(p, medium);
                const Complex phase = std::exp(Complex(0.0, 1.0) * (wave.z() * h + (p - m) * x));
                system(equation, unknown(p, medium, pol)) +=
                    (medium == 0 ? 1.0 : -1.0) * phase * along(field(wave, medium, pol), wave, row);
              }
          for (int pol : {0, 1}) {
            Vector3cd wave = wave_vector(0, 0);
            wave.z() = -wave.z();
            right(equation, pol) -=
                std::exp(Complex(0.0, 1.0) * (wave.z() * h - m * x)) * along(field(wave, 0, pol), wave, row);
          }
        }
    }
    solution_ = system.fullPivLu().solve(right);
  }

  /// Returns the amplitudes of an order, scaled so that their squares are powers. Rows are s and p of the outgoing
  /// light, columns those of the incident light.
  Eigen::Matrix2cd order(int m, Lobe lobe) const {
    const int medium = lobe == Lobe::reflection ? 0 : 1;
    const double q = std::abs(wave_vector(m, medium).z().real()), q_in = std::abs(wave_vector(0, 0).z().real());
    Eigen::Matrix2cd found;
    for (int out : {0, 1})
      for (int in : {0, 1}) found(out, in) = std::sqrt(q / q_in) * solution_(unknown(m, medium, out), in);
    return found;
  }
  bool propagates(int m, Lobe lobe) const {
    return (k_ + Vec2(m * g_, 0.0)).norm() < index_[lobe == Lobe::reflection ? 0 : 1];
  }

 private:
  static int unknown(int order, int medium, int pol) { return ((order + kOrders) * 2 + medium) * 2 + pol; }
  Vector3cd wave_vector(int order, int medium) const {
    const Vec2 k = k_ + Vec2(order * g_, 0.0);
    const double n = index_[static_cast<std::size_t>(medium)];
    const Complex q = std::sqrt(Complex(n * n - k.squaredNorm()));
    return {k.x(), k.y(), medium == 0 ? q : -q};
  }
  Vector3cd field(const Vector3cd& wave, int medium, int pol) const {
    const Vec2 k(wave.x().real(), wave.y().real());
    const Vector3cd s = Vector3cd(k.y(), -k.x(), 0.0) / k.norm();
    return pol == 0 ? s : Vector3cd(cross(wave, s) / index_[static_cast<std::size_t>(medium)]);
  }

  std::array<double, 2> index_;
  Vec2 k_;
  double g_;
  Eigen::MatrixXcd solution_;
};

using Grating = GratingOf<4>;

struct Incidence {
  double index_from, index_to, incidence_deg, azimuth_deg, g;
  Vec2 k() const {
    const double t = incidence_deg * kRadians, p = azimuth_deg * kRadians;
    return index_from * std::sin(t) * Vec2(std::cos(p), std::sin(p));
  }
};

/// Returns incidences from inside and outside, with gratings along and oblique to the plane of incidence. They include
/// total reflection, and angles just below and just above the critical angle (42.1 degrees).
const std::vector<Incidence>& incidences() {
  static const std::vector<Incidence> all = {
      {kIndex, 1.0, 5.0, 0.0, 0.4},     {kIndex, 1.0, 30.0, 35.0, 0.3},  {kIndex, 1.0, 41.9, 180.0, 0.05},
      {kIndex, 1.0, 42.3, 180.0, 0.05}, {kIndex, 1.0, 45.0, 60.0, 0.25}, {kIndex, 1.0, 45.0, 180.0, 0.3},
      {kIndex, 1.0, 54.74, 120.0, 0.9}, {kIndex, 1.0, 80.0, 150.0, 0.6}, {kIndex, 1.333, 70.0, 160.0, 0.2},
      {1.0, kIndex, 20.0, 20.0, 0.5},   {1.0, kIndex, 70.0, 100.0, 0.3}, {1.0, kIndex, 70.0, 10.0, 0.45}};
  return all;
}

Vec2 unit(const Vec2& v) {
  return v / v.norm();
}

// Compares both first orders of a grating whose depth of 1e-4 w / (2 pi) is very small. Every component is compared
// with its phase.
TEST(FirstOrder, IsTheFirstOrderOfAShallowGrating) {
  constexpr double kDepth = 1e-4;
  int compared = 0;
  for (const Incidence& i : incidences()) {
    const Grating grating(i.index_from, i.index_to, i.k(), i.g, kDepth);
    const DielectricInterface interface(i.index_from, i.index_to);
    for (const Lobe lobe : {Lobe::reflection, Lobe::transmission})
      for (const int m : {-1, 1}) {
        if (!grating.propagates(m, lobe)) continue;
        const Vec2 k_out = i.k() + Vec2(m * i.g, 0.0);
        const Polarisation2 f = interface.amplitudes(i.k().norm(), unit(i.k()), k_out, lobe);
        // The factor 1/2 is necessary because the cosine is the sum of both first orders, each with half of the depth.
        // The factor i is the delay of scattered fields by a quarter of a period.
        const Polarisation2 expected = grating.order(m, lobe) / (Complex(0.0, 1.0) * 0.5 * kDepth);
        EXPECT_LT((f - expected).norm(), 2e-5 * (1.0 + expected.norm()))
            << i.incidence_deg << " deg, order " << m << ", lobe " << static_cast<int>(lobe) << "\n"
            << f << "\n\n"
            << expected;
        ++compared;
      }
  }
  EXPECT_GE(compared, 30);
}

/// Returns the scattered fraction of unpolarised light, or of s or p, in units of (2 pi Sq / w)^2. It is integrated
/// over the discs of both sides by the midpoint rule, independently of the table.
double share_by_midpoints(const DielectricInterface& interface, double length, double k_in,
                          const Polarisation2& coherency, std::optional<Lobe> only = {}) {
  double sum = 0.0;
  for (const Lobe lobe : {Lobe::reflection, Lobe::transmission}) {
    if (only && *only != lobe) continue;
    const double n = interface.index_of(lobe);
    sum += n * n *
           disc_integral(
               [&](const Vec2& beta) {
                 const Vec2 k_out = n * beta;
                 const Polarisation2 f = interface.amplitudes(k_in, Vec2::UnitX(), k_out, lobe);
                 const double shift2 = (k_out - k_in * Vec2::UnitX()).squaredNorm();
                 return (f * coherency * f.adjoint()).trace().real() * length * length / (4.0 * std::numbers::pi) *
                        std::exp(-0.25 * length * length * shift2);
               },
               300, 150);
  }
  return sum;
}

const Polarisation2 kS = (Polarisation2() << 1.0, 0.0, 0.0, 0.0).finished();
const Polarisation2 kP = (Polarisation2() << 0.0, 0.0, 0.0, 1.0).finished();

ScatterEvent rough_event(double incidence_deg) {
  ScatterEvent event = inside(incidence_deg);
  event.inside_material = true;
  return event;
}

/// Converts a correlation length to units of w / (2 pi).
double in_waves(double length_um, double wavelength_nm = 550.0) {
  return 2e3 * std::numbers::pi * length_um / wavelength_nm;
}

// Compares the scattered fractions between the nodes of the table with integrals by the midpoint rule. Incidences are
// on both sides of the critical angle; correlation lengths are short and long.
TEST(FirstOrder, SharesAreIntegralsOverBothSides) {
  for (const auto& [from, to] : {std::pair(kIndex, 1.0), std::pair(1.0, kIndex), std::pair(kIndex, 1.333)}) {
    const DielectricInterface interface(from, to);
    for (const double length_um : {0.1, 0.39}) {
      const FirstOrderFraction share(interface, in_waves(length_um));
      for (const double incidence_deg : {20.0, 41.5, 42.5, 78.0}) {
        const double k = from * std::sin(incidence_deg * kRadians);
        const auto [s, p] = share.at(k);
        EXPECT_NEAR(s, share_by_midpoints(interface, in_waves(length_um), k, kS), 2e-3 * s) << length_um << " " << k;
        EXPECT_NEAR(p, share_by_midpoints(interface, in_waves(length_um), k, kP), 2e-3 * p) << length_um << " " << k;
      }
    }
  }
}

// To second order of the depth, the power that a shallow grating removes from the specular light is the power of its
// first orders.
TEST(FirstOrder, SpecularLightLosesWhatIsScattered) {
  constexpr double kDepth = 3e-3;
  for (const Incidence& i : incidences()) {
    const Grating grating(i.index_from, i.index_to, i.k(), i.g, kDepth);
    const DielectricInterface interface(i.index_from, i.index_to);
    for (const Polarisation2& state : {kS, kP}) {
      const auto power = [&](const Eigen::Matrix2cd& f) { return (f * state * f.adjoint()).trace().real(); };
      double specular = 0.0, scattered = 0.0;
      for (const Lobe lobe : {Lobe::reflection, Lobe::transmission}) {
        if (grating.propagates(0, lobe)) specular += power(grating.order(0, lobe));
        for (const int m : {-1, 1})
          if (grating.propagates(m, lobe))
            scattered += 0.25 * kDepth * kDepth *
                         power(interface.amplitudes(i.k().norm(), unit(i.k()), i.k() + Vec2(m * i.g, 0.0), lobe));
      }
      // The difference is of fourth order in the depth. It grows with the slope of the grating relative to 1 / q.
      EXPECT_NEAR((1.0 - specular) / scattered, 1.0, 1e-3) << i.incidence_deg;
    }
  }
}

// For small heights, the specular light on both sides loses the power R (1 - exp(-x_r)) + T (1 - exp(-x_t)), where x_r
// and x_t are the DiffractionMeans. This equals the power that the model scatters to both sides, below and above the
// critical angle. At total reflection, transmitted light loses nothing.
TEST(FirstOrder, MeansTakeWhatIsScatteredToBothSides) {
  for (const double length_um : {0.3, 1.5}) {
    const HarveyShack model({0.2, length_um, 0.0, 0.0}, {kIndex, 1.0, 550.0});
    for (const ScatterEvent& event : {rough_event(10.0), rough_event(35.0), rough_event(41.5), rough_event(42.8),
                                      rough_event(45.0), rough_event(70.0), outside(30.0), outside(75.0)}) {
      const auto fresnel = materials::fresnel(event.index_from / event.index_to, event.cos_in());
      const DiffractionMeans means = model.diffraction_means(event, {}, fresnel);
      const Vec3 s_axis = Vec3(event.direction_in.y(), -event.direction_in.x(), 0.0).normalized();
      for (const std::size_t pol : {0U, 1U}) {
        const double t = std::norm(pol == 0 ? fresnel.t_s : fresnel.t_p);
        const double taken = -(1.0 - t) * std::expm1(-means.reflected[pol]) - t * std::expm1(-means.transmitted[pol]);
        double scattered = 0.0;
        for (const Lobe lobe : {Lobe::reflection, Lobe::transmission})
          scattered += disc_integral(
              [&](const Vec2& beta) {
                return model.diffracted_once_density(event, {}, lobe, s_axis, pol == 0 ? kS : kP, beta);
              },
              300, 200);
        EXPECT_NEAR(taken / scattered, 1.0, 3e-3) << length_um << " um, " << std::acos(event.cos_in()) / kRadians;
        if (fresnel.total_reflection) {
          EXPECT_EQ(means.transmitted[pol], 0.0);
        }
      }
    }
  }
}

/// The power that Gaussian heights of variance 1 remove from reflected and transmitted light of s and of p, to second
/// order of the heights. To this order, the mean field is linear in the spectrum of the heights. The losses of gratings
/// of all periods and directions therefore add up. The Rayleigh method is independent of first-order theory.
struct Losses {
  std::array<double, 2> reflected{}, transmitted{};
};
Losses losses_by_gratings(double index_from, double index_to, double incidence_deg, double length) {
  constexpr int kRadii = 20, kAngles = 24;
  constexpr double kDepth = 1e-3;
  const double k = index_from * std::sin(incidence_deg * kRadians);
  const auto fresnel = materials::fresnel(index_from / index_to, std::cos(incidence_deg * kRadians));
  const std::array<double, 2> t = {std::norm(fresnel.t_s), std::norm(fresnel.t_p)};
  Losses sum;
  for (int a = 0; a < kAngles; ++a)
    for (int r = 0; r < kRadii; ++r) {
      // Each sample represents an equal fraction of the spectrum. The fraction of the spectrum below g is 1 -
      // exp(-(length g / 2)^2).
      const double g = 2.0 / length * std::sqrt(-std::log(1.0 - (r + 0.5) / kRadii));
      const double angle = 2.0 * std::numbers::pi * (a + 0.5) / kAngles;
      const GratingOf<1> grating(index_from, index_to, k * Vec2(std::cos(angle), std::sin(angle)), g, kDepth);
      const double weight = 1.0 / (kRadii * kAngles) / (0.5 * kDepth * kDepth);
      for (const int pol : {0, 1}) {
        const auto power = [&](Lobe lobe) { return grating.order(0, lobe).col(pol).squaredNorm(); };
        const auto p = static_cast<std::size_t>(pol);
        sum.reflected[p] += weight * (1.0 - t[p] - power(Lobe::reflection));
        if (t[p] > 0.0) sum.transmitted[p] += weight * (t[p] - power(Lobe::transmission));
      }
    }
  return sum;
}

// The split of the loss between R and T is an effect of second order. The model uses an approximate rule for it;
// docs/theory/scatter.md states the accuracy of this rule. The sum is correct, and beyond the critical angle only
// reflected light has a loss.
TEST(FirstOrder, ReflectedAndTransmittedLightShareTheLoss) {
  struct Split {
    double length_um, incidence_deg, within_s, within_p;  ///< maximum relative errors of the loss of R, for s and p
  };
  for (const auto& [length_um, incidence_deg, within_s, within_p] :
       {Split{5.0, 20.0, 0.01, 0.01}, Split{5.0, 36.0, 0.01, 0.02}, Split{1.0, 20.0, 0.01, 0.01},
        Split{1.0, 36.0, 0.03, 0.18}, Split{5.0, 50.0, 0.01, 0.01}, Split{1.0, 50.0, 0.01, 0.01}}) {
    const ScatterEvent event = rough_event(incidence_deg);
    const auto fresnel = materials::fresnel(kIndex, event.cos_in());
    const double height = 2.0 * std::numbers::pi * 0.1 / 550.0;
    const HarveyShack model({0.1, length_um, 0.0, 0.0}, {kIndex, 1.0, 550.0});
    const DiffractionMeans means = model.diffraction_means(event, {}, fresnel);
    const Losses exact = losses_by_gratings(kIndex, 1.0, incidence_deg, in_waves(length_um));
    const std::array<double, 2> within = {within_s, within_p};
    for (const std::size_t pol : {0U, 1U}) {
      const double t = std::norm(pol == 0 ? fresnel.t_s : fresnel.t_p);
      const double reflected = (1.0 - t) * means.reflected[pol] / (height * height);
      const double transmitted = t * means.transmitted[pol] / (height * height);
      const double both = exact.reflected[pol] + exact.transmitted[pol];
      EXPECT_NEAR((reflected + transmitted) / both, 1.0, 0.01) << length_um << " um, " << incidence_deg << " " << pol;
      EXPECT_NEAR(reflected / exact.reflected[pol], 1.0, within[pol])
          << length_um << " um, " << incidence_deg << " " << pol << " T " << transmitted << " "
          << exact.transmitted[pol];
    }
  }
}

// Reciprocity: reversed light has the same amplitude. F(in -> out) is the transpose of F(out -> in) except for the sign
// of s, whose axis rotates with the light.
TEST(FirstOrder, IsReciprocal) {
  for (const Incidence& i : incidences()) {
    const DielectricInterface there(i.index_from, i.index_to), back(i.index_to, i.index_from);
    for (const Vec2& k_out : {Vec2(0.3, -0.2), Vec2(-0.1, 0.85), Vec2(0.97, 0.1)})
      for (const Lobe lobe : {Lobe::reflection, Lobe::transmission}) {
        const DielectricInterface& from_there = lobe == Lobe::reflection ? there : back;
        const Polarisation2 f = there.amplitudes(i.k().norm(), unit(i.k()), k_out, lobe);
        const Polarisation2 g = from_there.amplitudes(k_out.norm(), -unit(k_out), -i.k(), lobe);
        for (int out : {0, 1})
          for (int in : {0, 1}) EXPECT_NEAR(std::abs(f(out, in)), std::abs(g(in, out)), 1e-12 * (1.0 + f.norm()));
      }
  }
}

// For correlation lengths much longer than the wavelength, heights only change the phase of Fresnel's amplitudes. In
// this limit, the phase model is valid.
TEST(FirstOrder, LongHeightsPutAPhaseOnFresnelsLight) {
  for (const Incidence& i : incidences()) {
    const DielectricInterface interface(i.index_from, i.index_to);
    const auto fresnel = materials::fresnel(i.index_from / i.index_to, std::cos(i.incidence_deg * kRadians));
    const double path = i.index_from * std::cos(i.incidence_deg * kRadians);
    const Polarisation2 f = interface.amplitudes(i.k().norm(), unit(i.k()), i.k(), Lobe::reflection);
    EXPECT_LT(std::abs(f(0, 0) + 2.0 * path * fresnel.r_s), 1e-12);
    EXPECT_LT(std::abs(f(1, 1) + 2.0 * path * fresnel.r_p), 1e-12);
    EXPECT_LT(std::abs(f(0, 1)) + std::abs(f(1, 0)), 1e-14);
    if (fresnel.total_reflection) continue;
    const double across = i.index_to * fresnel.cos_refracted - path;
    const Polarisation2 through = interface.amplitudes(i.k().norm(), unit(i.k()), i.k(), Lobe::transmission);
    EXPECT_LT(std::abs(through(0, 0) - across * fresnel.t_s), 1e-12);
    EXPECT_LT(std::abs(through(1, 1) - across * fresnel.t_p), 1e-12);
  }
}

Polarisation2 askew() {
  Polarisation2 made;
  made << 0.6, Complex(0.2, 0.35), Complex(0.2, -0.35), 0.4;
  return made;
}

// Draws in both hemispheres follow the density, for light of every polarisation, below and above the critical angle.
// The coherency of each draw equals the coherency that diffracted_once_into() returns for its direction.
TEST(FirstOrder, DrawsFollowTheDensity) {
  constexpr std::uint32_t kDraws = 60000;
  const Roughness heights = {5.0, 0.39, 4.0, 8.0};
  const HarveyShack model(heights, {kIndex, 1.0, 550.0});
  const std::vector<double> all_deg = {20.0, 41.0, 45.0, 70.0};
  const double level = sidak_level(2 * all_deg.size());
  std::uint32_t seed = 100;
  for (const double incidence_deg : all_deg) {
    const ScatterEvent event = rough_event(incidence_deg);
    const Vec3 s_axis = event.direction_in.cross(Vec3::UnitZ()).normalized();
    const double k = kIndex * std::sin(incidence_deg * kRadians);
    const materials::FresnelCoefficients f = materials::fresnel(kIndex, event.cos_in());
    const DiffractionMeans means = model.diffraction_means(event, {}, f);
    const double t_s = std::norm(f.t_s), t_p = std::norm(f.t_p);
    const double total = askew()(0, 0).real() * ((1.0 - t_s) * means.reflected[0] + t_s * means.transmitted[0]) +
                         askew()(1, 1).real() * ((1.0 - t_p) * means.reflected[1] + t_p * means.transmitted[1]);
    for (const Lobe lobe : {Lobe::reflection, Lobe::transmission}) {
      const Rings rings(lobe == Lobe::reflection ? Vec2(event.direction_in.head<2>())
                                                 : Vec2(event.direction_in.head<2>().normalized() * std::min(0.8, k)),
                        0.15);
      const Density density = [&](const Vec2& beta) {
        return model.diffracted_once_density(event, {}, lobe, s_axis, askew(), beta) / total;
      };
      const Draw draw = [&](RandomStream& random) -> std::optional<Vec2> {
        const auto once = model.draw_diffracted_once(event, {}, s_axis, askew(), random);
        if (!once || once->lobe != lobe) return std::nullopt;
        EXPECT_NEAR(once->coherency.trace().real(), 1.0, 1e-12);
        EXPECT_LT(std::abs(once->s_axis.dot(once->direction)), 1e-12);
        const auto into = model.diffracted_once_into(event, {}, s_axis, askew(), once->direction);
        const double share = into.coherency.trace().real();
        EXPECT_NEAR(share / density(once->direction.head<2>()), 1.0, 1e-4);
        EXPECT_LT((into.coherency / share - once->coherency).norm(), 1e-9);
        EXPECT_LT((into.s_axis - once->s_axis).norm(), 1e-9);
        return Vec2(once->direction.head<2>());
      };
      EXPECT_GT(chi_square_p(rings, density, draw, ++seed, kDraws), level)
          << incidence_deg << ", lobe " << static_cast<int>(lobe);
    }
  }
}

// For correlation lengths much longer than the wavelength, the mean numbers of diffractions equal the phase variances.
// For short correlation lengths, they are smaller at total reflection.
TEST(FirstOrder, MeansAreThePhaseVariancesOfLongHeights) {
  const double sq_nm = 10.0;
  for (const double incidence_deg : {0.0, 20.0, 50.0, 54.74, 70.0}) {
    const ScatterEvent event = rough_event(incidence_deg);
    const materials::FresnelCoefficients f = materials::fresnel(kIndex, event.cos_in());
    const auto mean_of = [&](double length_um) {
      return HarveyShack({sq_nm, length_um, 0.0, 0.0}, {kIndex, 1.0, 550.0}).diffraction_means(event, {}, f);
    };
    const double phase = 4.0 * std::numbers::pi * kIndex * sq_nm * event.cos_in() / 550.0;
    const DiffractionMeans longest = mean_of(200.0), middle = mean_of(20.0), short_one = mean_of(0.39);
    for (const std::size_t pol : {0U, 1U}) {
      const double off = std::abs(middle.reflected[pol] / (phase * phase) - 1.0);
      EXPECT_NEAR(longest.reflected[pol] / (phase * phase), 1.0, 1e-5) << incidence_deg;
      EXPECT_LT(off, 1.5e-3);
      if (f.total_reflection) {
        EXPECT_LT(short_one.reflected[pol], 0.8 * phase * phase);
        EXPECT_EQ(short_one.transmitted[pol], 0.0);
      }
    }
  }
}

// An upper bound of the density is used for drawing. It must hold for every index ratio, incidence and direction, and
// some directions must come close to it.
TEST(FirstOrder, BoundHolds) {
  double closest = 0.0;
  for (const double ratio : {0.4, 0.67, 0.9, 1.02, 1.12, 1.49, 2.0, 3.0}) {
    const DielectricInterface interface(ratio, 1.0);
    const double most = std::max(ratio, 1.0);
    for (int a = 0; a < 30; ++a) {
      const double k_in = ratio * std::sin((3 * a + 1.5) * kRadians);
      for (const Polarisation2& state : {kS, kP, Polarisation2(0.5 * (kS + kP))}) {
        const double bound = interface.bound(k_in, state);
        for (int r = 0; r < 200; ++r)
          for (int phi = 0; phi <= 4; ++phi) {
            const double k = most * (r + 0.5) / 200.0, angle = std::numbers::pi / 4.0 * phi;
            double sum = 0.0;
            for (const Lobe lobe : {Lobe::reflection, Lobe::transmission}) {
              if (k >= interface.index_of(lobe)) continue;
              const Polarisation2 f =
                  interface.amplitudes(k_in, Vec2::UnitX(), k * Vec2(std::cos(angle), std::sin(angle)), lobe);
              sum += (f * state * f.adjoint()).trace().real();
            }
            ASSERT_LE(sum, bound * (1.0 + 1e-12)) << ratio << " " << a << " " << k;
            closest = std::max(closest, sum / bound);
          }
      }
    }
  }
  EXPECT_GT(closest, 0.95);
}

}  // namespace
}  // namespace retrace::testing::first_order_test
