#pragma once

// A reference for diffraction with roughness. Facets with random heights are treated as phase screens. Rays through an
// element are traced one by one. The fields of all paths are added over the aperture by fast Fourier transforms.

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <deque>
#include <numbers>
#include <optional>
#include <vector>

#include "core/random.h"
#include "raytrace/observers/far_field.h"
#include "surface_models/fft.h"
#include "tests/support/closed_forms.h"
#include "tests/support/designs.h"

namespace retrace::testing::phase_screens {

using namespace geometry;
using namespace raytrace;
using std::numbers::pi;
using Complex = std::complex<double>;

inline constexpr double kWaveNm = 550.0;
inline constexpr double kWave = 1e-6 * kWaveNm;

inline surface_models::Roughness rough(double sq_nm, double length_um) {
  return {sq_nm, length_um, 0.0, 0.0};
}

inline Optics optics_of(const surface_models::Roughness& roughness, bool mirrors) {
  Optics optics = pmma();
  optics.mirror_facets = mirrors;
  optics.lossless_entrance = true;
  optics.wavelength_nm = kWaveNm;
  if (roughness.sq_nm > 0.0 || roughness.waviness_sq_nm > 0.0)
    optics.facet_scatter = surface_models::HarveyShack(roughness);
  return optics;
}

inline FarField engine_field(const Part& part, const Optics& optics, const Illumination& light = {}) {
  FarFieldPolicy policy;
  policy.wavelength_nm = kWaveNm;
  policy.window_rad = 0.1;
  FarFieldCollector collector(part, light, policy);
  BeamPolicy beams;
  beams.truncated_goal = 1e-6;
  beams.separate_cells = true;
  beams.keeps_phases = !optics.is_smooth();
  BeamTracer(part).trace(optics, light, {0.5}, beams, nullptr, [&](const ReturnedBeam& b) { collector.add(b); });
  return collector.finish();
}

/// An element whose facets are planes through its apex or root. The apex or root is at the origin. Light falls along
/// the normal.
class Screens {
 public:
  static Screens cube(double aperture_mm, bool mirrors) {
    Screens made;
    made.mirrors_ = mirrors;
    made.half_ = 0.5 * aperture_mm;
    made.depth_ = made.half_ * std::sqrt(2.0);
    const double edge = aperture_mm / (2.0 * std::sqrt(2.0 / 3.0));
    made.facet_size_ = edge;
    for (int k = 0; k < 3; ++k) {
      const double a = (120.0 * k + 60.0 + 180.0) * kDeg;
      made.normals_.push_back(
          {std::sqrt(2.0 / 3.0) * std::cos(a), std::sqrt(2.0 / 3.0) * std::sin(a), 1.0 / std::sqrt(3.0)});
    }
    for (std::size_t k = 0; k < 3; ++k) made.axes_.push_back({made.normals_[(k + 1) % 3], made.normals_[(k + 2) % 3]});
    for (int k = 0; k < 6; ++k) {
      const double a = (60.0 * k + 30.0) * kDeg;
      made.borders_.push_back({std::cos(a), std::sin(a), edge / std::numbers::sqrt2});
    }
    return made;
  }
  static Screens prism(double base_mm, bool mirrors) {
    Screens made;
    made.mirrors_ = mirrors;
    made.half_ = 0.5 * base_mm;
    made.facet_size_ = base_mm;
    const double h = std::sqrt(0.5);
    made.normals_ = {{h, 0.0, h}, {-h, 0.0, h}};
    made.axes_ = {{Vec3(-h, 0.0, h), Vec3::UnitY()}, {Vec3(h, 0.0, h), Vec3::UnitY()}};
    for (const Vec2& d : {Vec2(1, 0), Vec2(-1, 0), Vec2(0, 1), Vec2(0, -1)})
      made.borders_.push_back({d.x(), d.y(), made.half_});
    return made;
  }

  double half() const { return half_; }
  double facet_size() const { return facet_size_; }
  std::size_t facets() const { return normals_.size(); }

  struct Hit {
    std::size_t facet = 0;
    Vec2 place = Vec2::Zero();  ///< position along the axes of the facet
    double cosine = 0.0;
  };
  struct Ray {
    Vec2 out;
    Eigen::Matrix2cd field;  ///< x and y components of the field, for incident light polarised along x and y
    std::vector<Hit> hits;
  };

  /// Traces light that falls vertically on a point. Returns nothing if the point is outside of the aperture.
  std::optional<Ray> trace(const Vec2& place) const {
    for (const Vec3& b : borders_)
      if (b.head<2>().dot(place) > b.z()) return std::nullopt;
    Ray ray;
    Vec3 p(place.x(), place.y(), 10.0);
    Vec3 d = -Vec3::UnitZ();
    Eigen::Matrix<Complex, 3, 2> field = Eigen::Matrix<Complex, 3, 2>::Zero();
    field(0, 0) = field(1, 1) = 1.0;
    while (d.z() < 0.999) {
      double nearest = 1e9;
      std::size_t facet = facets();
      for (std::size_t k = 0; k < facets(); ++k) {
        if (normals_[k].dot(d) >= -1e-9 || (!ray.hits.empty() && ray.hits.back().facet == k)) continue;
        const double t = -normals_[k].dot(p) / normals_[k].dot(d);
        if (t > 0.0 && t < nearest) {
          nearest = t;
          facet = k;
        }
      }
      if (facet == facets()) return std::nullopt;
      p += nearest * d;
      ray.hits.push_back({facet, {p.dot(axes_[facet][0]), p.dot(axes_[facet][1])}, -normals_[facet].dot(d)});
      reflect(normals_[facet], d, field);
    }
    ray.out = p.head<2>();
    ray.field = field.topRows<2>();
    return ray;
  }

 private:
  void reflect(const Vec3& normal, Vec3& d, Eigen::Matrix<Complex, 3, 2>& field) const {
    const double c = -normal.dot(d);
    Complex rs = -1.0;
    Complex rp = 1.0;
    if (!mirrors_) {
      // Born and Wolf, 1.5.2 (20). For total reflection, the sign of the root is that of the time dependence exp(-i w
      // t).
      const double m = 1.0 / (kPmma * kPmma);
      const Complex root = std::sqrt(Complex(m - (1.0 - c * c)));
      rs = (c - root) / (c + root);
      rp = (m * c - root) / (m * c + root);
    }
    const Vec3 s = d.cross(-normal).normalized();
    const Vec3 p_in = d.cross(s);
    const Vec3 d_out = d + 2.0 * c * normal;
    const Vec3 p_out = d_out.cross(s);
    const Eigen::Matrix<Complex, 1, 2> along_s = s.transpose().cast<Complex>() * field;
    const Eigen::Matrix<Complex, 1, 2> along_p = p_in.transpose().cast<Complex>() * field;
    field = rs * s.cast<Complex>() * along_s + rp * p_out.cast<Complex>() * along_p;
    d = d_out;
  }

  bool mirrors_ = true;
  double half_ = 0.0, depth_ = 0.0, facet_size_ = 0.0;
  std::vector<Vec3> normals_;
  std::vector<std::array<Vec3, 2>> axes_;
  std::vector<Vec3> borders_;  ///< half planes: direction cosines and distance
};

/// Random heights of unit variance with the autocorrelation exp(-r^2 / l^2). They are periodic, with a period larger
/// than a facet.
class Heights {
 public:
  Heights(double size_mm, double length_mm)
      : step_(length_mm / 10.0),
        points_(surface_models::fast_length(static_cast<std::size_t>((size_mm + 4.0 * length_mm) / step_))),
        fft_(points_, points_) {
    double sum = 0.0;
    for (std::size_t r = 0; r < points_; ++r)
      for (std::size_t c = 0; c < points_; ++c) sum += std::pow(filter(r, c, length_mm), 2.0);
    scale_ = static_cast<double>(points_) / std::sqrt(sum);
    length_ = length_mm;
  }

  void draw(std::uint32_t stream, std::uint32_t realisation) {
    const std::size_t count = points_ * points_;
    for (std::size_t k = 0; k < count; k += 4) {
      const auto words = philox({20, stream}, static_cast<std::uint32_t>(k), realisation);
      for (std::size_t pair = 0; pair < 2; ++pair) {
        const double radius = std::sqrt(-2.0 * std::log(1.0 - unit_interval(words[2 * pair])));
        const double angle = 2.0 * pi * unit_interval(words[2 * pair + 1]);
        if (k + 2 * pair < count) fft_.field()[k + 2 * pair] = radius * std::cos(angle);
        if (k + 2 * pair + 1 < count) fft_.field()[k + 2 * pair + 1] = radius * std::sin(angle);
      }
    }
    fft_.forward();
    for (std::size_t r = 0; r < points_; ++r)
      for (std::size_t c = 0; c < fft_.spectrum_columns(); ++c)
        fft_.spectrum()[r * fft_.spectrum_columns() + c] *= scale_ * filter(r, c, length_);
    fft_.inverse();
  }

  struct Place {
    std::array<std::size_t, 4> at;
    std::array<double, 4> weight;
  };
  Place place(const Vec2& mm) const {
    const double n = static_cast<double>(points_);
    const double x = mm.x() / step_ - n * std::floor(mm.x() / step_ / n);
    const double y = mm.y() / step_ - n * std::floor(mm.y() / step_ / n);
    const auto i = static_cast<std::size_t>(x) % points_;
    const auto j = static_cast<std::size_t>(y) % points_;
    const double u = x - std::floor(x);
    const double v = y - std::floor(y);
    const std::size_t next_i = (i + 1) % points_;
    const std::size_t next_j = (j + 1) % points_;
    return {{j * points_ + i, j * points_ + next_i, next_j * points_ + i, next_j * points_ + next_i},
            {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v}};
  }
  double at(const Place& p) {
    double sum = 0.0;
    for (std::size_t k = 0; k < 4; ++k) sum += p.weight[k] * fft_.field()[p.at[k]];
    return sum;
  }

 private:
  double filter(std::size_t r, std::size_t c, double length_mm) const {
    const auto frequency = [&](std::size_t k) {
      const double n = static_cast<double>(points_);
      const double signed_k = 2 * k > points_ ? static_cast<double>(k) - n : static_cast<double>(k);
      return signed_k / (n * step_);
    };
    const double f2 = std::pow(frequency(r), 2.0) + std::pow(frequency(c), 2.0);
    return std::exp(-0.5 * pi * pi * length_mm * length_mm * f2);
  }

  double step_;
  std::size_t points_;
  surface_models::RealFft fft_;
  double scale_ = 1.0;
  double length_ = 0.0;
};

/// The far field of the aperture. It is computed in the bins of a Fourier transform, and in single directions (nodes).
struct Pattern {
  std::vector<double> bins;   ///< power per area of direction cosines; non-negative frequencies first
  std::vector<double> nodes;  ///< power per area of direction cosines, in single directions
};

/// The fields of all paths over the aperture, on a grid of pixels.
class Aperture {
 public:
  /// \param pixels number of pixels along the diameter of the aperture
  /// \param nodes direction cosines of single directions
  Aperture(const Screens& screens, std::size_t pixels, std::vector<Vec2> nodes)
      : step_(2.0 * screens.half() / static_cast<double>(pixels)),
        points_(surface_models::fast_length(pixels + pixels / 2)),
        nodes_(std::move(nodes)),
        re_(points_, points_),
        im_(points_, points_) {
    for (std::size_t j = 0; j < pixels; ++j)
      for (std::size_t i = 0; i < pixels; ++i) {
        const Vec2 at = step_ * Vec2(static_cast<double>(i) + 0.5, static_cast<double>(j) + 0.5) -
                        Vec2(screens.half(), screens.half());
        if (auto ray = screens.trace(at)) {
          // A ray that enters at the center of a pixel leaves at the center of a pixel.
          const Vec2 out = (ray->out + Vec2(screens.half(), screens.half())) / step_;
          cell_.push_back(static_cast<std::size_t>(out.y()) * points_ + static_cast<std::size_t>(out.x()));
          rays_.push_back(std::move(*ray));
        }
      }
    for (const Vec2& q : nodes_)
      for (const Screens::Ray& ray : rays_) {
        const double phase = -2.0 * pi / kWave * q.dot(ray.out);
        waves_.emplace_back(std::cos(phase), std::sin(phase));
      }
  }

  const std::vector<Screens::Ray>& rays() const { return rays_; }
  double bin_width() const { return kWave / (static_cast<double>(points_) * step_); }

  /// Adds |field|^2 to the pattern. The field of each pixel is multiplied by one of `factors`. The incident light is
  /// unpolarised and has the power 1.
  void add(const std::vector<Complex>& factors, double weight, Pattern& pattern) {
    pattern.bins.resize(points_ * points_, 0.0);
    pattern.nodes.resize(nodes_.size(), 0.0);
    const double scale = 0.5 * weight * std::pow(step_ / kWave, 2.0) / static_cast<double>(rays_.size());
    for (Eigen::Index part = 0; part < 4; ++part) {
      std::fill(re_.field().begin(), re_.field().end(), 0.0);
      std::fill(im_.field().begin(), im_.field().end(), 0.0);
      bool is_dark = true;
      std::vector<Complex> field(rays_.size());
      for (std::size_t k = 0; k < rays_.size(); ++k) {
        field[k] = factors[k] * rays_[k].field.reshaped()(part);
        is_dark = is_dark && std::abs(rays_[k].field.reshaped()(part)) < 1e-9;
        re_.field()[cell_[k]] = field[k].real();
        im_.field()[cell_[k]] = field[k].imag();
      }
      if (is_dark) continue;
      for (std::size_t n = 0; n < nodes_.size(); ++n) {
        Complex sum = 0.0;
        for (std::size_t k = 0; k < field.size(); ++k) sum += field[k] * waves_[n * field.size() + k];
        pattern.nodes[n] += scale * std::norm(sum);
      }
      re_.forward();
      im_.forward();
      const std::size_t half = re_.spectrum_columns();
      for (std::size_t r = 0; r < points_; ++r)
        for (std::size_t c = 0; c < half; ++c) {
          const Complex a = re_.spectrum()[r * half + c];
          const Complex b = im_.spectrum()[r * half + c];
          const Complex i(0.0, 1.0);
          pattern.bins[r * points_ + c] += scale * std::norm(a + i * b);
          // At the opposite frequency, both components are complex conjugates.
          const std::size_t column = (points_ - c) % points_;
          if (column >= half)
            pattern.bins[(points_ - r) % points_ * points_ + column] +=
                scale * std::norm(std::conj(a) + i * std::conj(b));
        }
    }
  }

  /// Returns the power within a cone. Bins at the edge count with the fraction of their area that is inside.
  double within(const Pattern& pattern, double half_angle_deg) const {
    const double radius = std::sin(half_angle_deg * kDeg) / bin_width();
    const auto n = static_cast<std::ptrdiff_t>(points_);
    const auto reach = std::min(static_cast<std::ptrdiff_t>(radius) + 2, n / 2 - 1);
    constexpr int kParts = 10;
    double sum = 0.0;
    for (std::ptrdiff_t r = -reach; r <= reach; ++r)
      for (std::ptrdiff_t c = -reach; c <= reach; ++c) {
        int inside = 0;
        for (int j = 0; j < kParts; ++j)
          for (int i = 0; i < kParts; ++i)
            inside += std::hypot(static_cast<double>(c) + (i + 0.5) / kParts - 0.5,
                                 static_cast<double>(r) + (j + 0.5) / kParts - 0.5) <= radius;
        sum += inside * pattern.bins[static_cast<std::size_t>((r + n) % n * n + (c + n) % n)];
      }
    return sum / (kParts * kParts) * bin_width() * bin_width();
  }

 private:
  double step_;
  std::size_t points_;
  std::vector<Vec2> nodes_;
  surface_models::RealFft re_, im_;
  std::vector<Screens::Ray> rays_;
  std::vector<std::size_t> cell_;
  std::vector<Complex> waves_;
};

struct Case {
  bool is_cube = false;
  bool mirrors = false;
  double size_mm = 0.0;
  double length_um = 0.0;
  std::size_t pixels = 0;
  std::uint32_t realisations = 0;
  std::vector<double> cones_deg;
  std::vector<Vec2> nodes;
};

inline constexpr std::array<double, 2> kSqNm = {5.0, 20.0};

/// Far fields of the light that heights with each value of kSqNm scatter, and the factors by which these heights reduce
/// the mean amplitude.
struct Scattered {
  std::array<Pattern, 2> patterns;
  std::array<double, 2> mean_factors = {};
};

/// Returns means over random realisations of the heights. The field is the sum of its known mean and a fluctuation. The
/// powers of both are added, because the mean of their product is 0.
inline Scattered screened(const Screens& screens, Aperture& aperture, const Case& c) {
  std::deque<Heights> heights;
  for (std::size_t k = 0; k < screens.facets(); ++k) heights.emplace_back(screens.facet_size(), 1e-3 * c.length_um);
  struct Point {
    Heights::Place place;
    std::size_t facet;
    double rad_per_nm;
  };
  std::vector<std::vector<Point>> points;
  double variance_per_nm2 = 0.0;
  for (const Screens::Ray& ray : aperture.rays()) {
    points.emplace_back();
    variance_per_nm2 = 0.0;
    for (const Screens::Hit& hit : ray.hits) {
      const double rad_per_nm = 4.0 * pi * kPmma * hit.cosine / kWaveNm;
      points.back().push_back({heights[hit.facet].place(hit.place), hit.facet, rad_per_nm});
      variance_per_nm2 += rad_per_nm * rad_per_nm;
    }
  }
  Scattered scattered;
  for (std::size_t s = 0; s < kSqNm.size(); ++s)
    scattered.mean_factors[s] = std::exp(-0.5 * kSqNm[s] * kSqNm[s] * variance_per_nm2);
  std::vector<double> phases_per_nm(points.size());
  std::vector<Complex> factors(points.size());
  for (std::uint32_t realisation = 0; realisation < c.realisations; ++realisation) {
    for (std::size_t k = 0; k < heights.size(); ++k) heights[k].draw(static_cast<std::uint32_t>(k), realisation);
    for (std::size_t k = 0; k < points.size(); ++k) {
      phases_per_nm[k] = 0.0;
      for (const Point& p : points[k]) phases_per_nm[k] += p.rad_per_nm * heights[p.facet].at(p.place);
    }
    for (std::size_t s = 0; s < kSqNm.size(); ++s) {
      for (std::size_t k = 0; k < points.size(); ++k)
        factors[k] = std::polar(1.0, kSqNm[s] * phases_per_nm[k]) - scattered.mean_factors[s];
      aperture.add(factors, 1.0 / c.realisations, scattered.patterns[s]);
    }
  }
  return scattered;
}

}  // namespace retrace::testing::phase_screens
