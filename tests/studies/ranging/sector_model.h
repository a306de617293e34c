#pragma once

// Independent model of the far field of a solid cube corner. It shares no code with the engine. A sector is the region
// of the entrance face whose light meets the three facets in the same order. The model traces rays from points of the
// face through an ideal cube to determine the sector of each pixel. Fresnel's formulas at the facets, including their
// angle errors, give the Jones matrix and the direction of each sector. A discrete Fourier transform of all sectors
// gives the far field.

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>
#include <optional>
#include <vector>

namespace retrace::testing {

/// Properties of a cube for the sector model.
struct SectorCube {
  double aperture_mm = 38.1;  ///< diameter of the circular face, or of the hexagon's circumscribed circle
  double thickness_mm = 0.1;
  double index = 1.46;
  double wavelength_nm = 532.0;
  std::array<double, 3> errors_arcsec{};
  std::optional<std::complex<double>> metal = {};  ///< complex index of an opaque metal coating; empty: no coating
  double incidence_deg = 0.0;
  double azimuth_deg = 0.0;
  bool is_round = false;   ///< true: circular face; false: hexagonal face
  double recess_mm = 0.0;  ///< depth of a circular face below the edge of its mount
};

/// Far field of a cube corner on a square grid of direction cosines around the direction to the source.
class SectorModel {
 public:
  using Vec2 = Eigen::Vector2d;
  using Vec3 = Eigen::Vector3d;
  using Complex = std::complex<double>;
  using Jones = Eigen::Matrix2cd;

  explicit SectorModel(const SectorCube& cube, int pixels = 256, int subpixels = 4)
      : cube_(cube), pixels_(pixels), edge_(cube.aperture_mm / (2.0 * std::sqrt(2.0 / 3.0))) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double a = 2.0 * std::numbers::pi / 3.0 * static_cast<double>(k);
      edges_[k] = Vec3(std::sqrt(2.0 / 3.0) * std::cos(a), std::sqrt(2.0 / 3.0) * std::sin(a), 1.0 / std::sqrt(3.0));
    }
    const double t = cube.incidence_deg * std::numbers::pi / 180.0;
    const double p = cube.azimuth_deg * std::numbers::pi / 180.0;
    to_source_ = Vec3(std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t));
    right_ = (Vec3::UnitX() - to_source_.x() * to_source_).normalized();
    up_ = to_source_.cross(right_);
    apex_ = Vec3(0.0, 0.0, -2.0 * edge_ / std::sqrt(3.0));
    step_mm_ = cube.aperture_mm / pixels;
    find_sectors(subpixels);
    tilt_facets();
    for (auto& [order, sector] : sectors_) trace_sector(order, sector);
  }

  const Vec3& to_source() const { return to_source_; }
  /// Returns the area of the entrance face from which light returns, projected perpendicular to the beam.
  double active_mm2() const {
    double sum = 0.0;
    for (const auto& [order, sector] : sectors_) sum += sector.weights.sum();
    return sum * step_mm_ * step_mm_ * to_source_.z();
  }

  /// Returns a Jones matrix for each direction, along the axes (right, up). Directions are ordered row by row along y.
  /// The squared moduli are cross sections in m2.
  /// \param offsets direction cosines relative to the direction to the source
  std::vector<Jones> far_field(const std::vector<double>& offsets) const {
    const double wavelength_mm = 1e-6 * cube_.wavelength_nm;
    const double k0 = 2.0 * std::numbers::pi / wavelength_mm;
    const auto count = static_cast<Eigen::Index>(offsets.size());
    std::vector<Jones> sum(offsets.size() * offsets.size(), Jones::Zero());
    for (const auto& [order, sector] : sectors_) {
      Eigen::MatrixXcd along_x(pixels_, count), along_y(pixels_, count);
      for (Eigen::Index pixel = 0; pixel < pixels_; ++pixel)
        for (Eigen::Index m = 0; m < count; ++m) {
          const double offset = offsets[static_cast<std::size_t>(m)];
          const Vec2 kappa = k0 * (to_source_.head<2>() + Vec2(offset, offset) - sector.cosines);
          along_x(pixel, m) = pixel_wave(kappa.x(), exit_at(pixel, 0));
          along_y(pixel, m) = pixel_wave(kappa.y(), exit_at(pixel, 1));
        }
      const Eigen::MatrixXcd pattern = along_y.transpose() * sector.weights.transpose() * along_x;
      for (Eigen::Index row = 0; row < count; ++row)
        for (Eigen::Index column = 0; column < count; ++column)
          sum[static_cast<std::size_t>(row * count + column)] +=
              pattern(row, column) * step_mm_ * step_mm_ * sector.phase * sector.jones;
    }
    // The beam has the area A cos t, where t is the angle of incidence. The intensity per solid angle contains another
    // factor cos t.
    const double scale = std::sqrt(4.0 * std::numbers::pi * 1e-6) / wavelength_mm * to_source_.z();
    for (Jones& jones : sum) jones *= scale;
    return sum;
  }

 private:
  struct Sector {
    Eigen::MatrixXd weights;  ///< covered fraction of each pixel at the entry points; first index: x
    Vec2 cosines = Vec2::Zero();
    Jones jones = Jones::Zero();
    Complex phase = 1.0;
  };
  using Order = std::array<int, 3>;

  Vec3 inside_direction() const {
    Vec3 d = -to_source_ / cube_.index;
    d.z() = -std::sqrt(1.0 - d.head<2>().squaredNorm());
    return d;
  }
  double entry_at(Eigen::Index pixel) const { return (static_cast<double>(pixel) + 0.5 - 0.5 * pixels_) * step_mm_; }
  /// Returns one coordinate of the exit point of light that enters at the centre of a pixel. Entry point and exit point
  /// are symmetric about the image of the apex.
  double exit_at(Eigen::Index pixel, int axis) const {
    const Vec3 d = inside_direction();
    const double centre = apex_[axis] + (cube_.thickness_mm - apex_.z()) * d[axis] / d.z();
    return 2.0 * centre - entry_at(pixel);
  }
  /// Returns the mean of exp(-i kappa x) over the width of a pixel.
  Complex pixel_wave(double kappa, double x) const {
    const double half = 0.5 * kappa * step_mm_;
    return std::polar(std::abs(half) > 1e-9 ? std::sin(half) / half : 1.0, -kappa * x);
  }

  void find_sectors(int subpixels) {
    const double weight = 1.0 / (subpixels * subpixels);
    for (int i = 0; i < pixels_; ++i)
      for (int j = 0; j < pixels_; ++j)
        for (int k = 0; k < subpixels * subpixels; ++k) {
          const Vec2 offset((k % subpixels + 0.5) / subpixels - 0.5, (k / subpixels + 0.5) / subpixels - 0.5);
          const std::optional<Order> order = order_of(Vec2(entry_at(i), entry_at(j)) + step_mm_ * offset);
          if (!order) continue;
          auto [it, is_new] = sectors_.try_emplace(*order);
          if (is_new) it->second.weights = Eigen::MatrixXd::Zero(pixels_, pixels_);
          it->second.weights(i, j) += weight;
        }
  }

  bool is_in_outline(const Vec2& p) const {
    if (cube_.is_round) return p.norm() <= 0.5 * cube_.aperture_mm;
    for (int k = 0; k < 6; ++k) {
      const double a = (60.0 * k + 30.0) * std::numbers::pi / 180.0;
      if (p.x() * std::cos(a) + p.y() * std::sin(a) > edge_ / std::numbers::sqrt2) return false;
    }
    return true;
  }

  /// Returns true if light that enters or leaves at a point of the face is inside the circular edge of the mount.
  bool passes_mount(const Vec2& at) const {
    return is_in_outline(at + cube_.recess_mm / to_source_.z() * to_source_.head<2>());
  }

  /// Returns the order in which light meets the facets if it enters at a given point. Returns nothing if the light
  /// meets a side or the mount.
  std::optional<Order> order_of(const Vec2& at) const {
    if (!is_in_outline(at) || !passes_mount(at)) return std::nullopt;
    Vec3 p(at.x(), at.y(), cube_.thickness_mm);
    Vec3 d = inside_direction();
    Order order{};
    for (std::size_t bounce = 0; bounce < 3; ++bounce) {
      double nearest = 1e9;
      int facet = -1;
      for (int k = 0; k < 3; ++k) {
        const Vec3& normal = edges_[static_cast<std::size_t>(k)];
        const double speed = normal.dot(d);
        if (speed >= -1e-12) continue;
        const double t = -normal.dot(p - apex_) / speed;
        if (t > 1e-9 && t < nearest) {
          nearest = t;
          facet = k;
        }
      }
      if (facet < 0) return std::nullopt;
      p += nearest * d;
      if (!is_in_outline(p.head<2>()) || p.z() > cube_.thickness_mm) return std::nullopt;
      const Vec3& normal = edges_[static_cast<std::size_t>(facet)];
      d -= 2.0 * normal.dot(d) * normal;
      order[bounce] = facet;
    }
    p += (cube_.thickness_mm - p.z()) / d.z() * d;
    if (!is_in_outline(p.head<2>()) || !passes_mount(p.head<2>())) return std::nullopt;
    return order;
  }

  /// Sets the inward normals of the facets. Among all normals with the required angle errors, those nearest to the
  /// ideal normals are used.
  void tilt_facets() {
    Eigen::Matrix3d gram = Eigen::Matrix3d::Identity();
    for (int k = 0; k < 3; ++k) {
      const double error = cube_.errors_arcsec[static_cast<std::size_t>(k)] * std::numbers::pi / (180.0 * 3600.0);
      gram((k + 1) % 3, (k + 2) % 3) = gram((k + 2) % 3, (k + 1) % 3) = std::sin(error);
    }
    const Eigen::Matrix3d root = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(gram).operatorSqrt();
    for (int i = 0; i < 3; ++i) {
      normals_[static_cast<std::size_t>(i)] = Vec3::Zero();
      for (int j = 0; j < 3; ++j)
        normals_[static_cast<std::size_t>(i)] += root(i, j) * edges_[static_cast<std::size_t>(j)];
    }
  }

  /// Field vectors of the light for unit amplitudes along each of the two axes of the source.
  using Field = Eigen::Matrix<Complex, 3, 2>;

  static void resolve(const Vec3& d_in, const Vec3& d_out, const Vec3& normal, Complex along_s, Complex along_p,
                      Field& field) {
    Vec3 s = d_in.cross(normal);
    s = s.norm() > 1e-12 ? s.normalized() : Vec3(d_in.cross(Vec3::UnitX()).normalized());
    const Eigen::Matrix<Complex, 1, 2> s_part = s.transpose().cast<Complex>() * field;
    const Eigen::Matrix<Complex, 1, 2> p_part = d_in.cross(s).transpose().cast<Complex>() * field;
    field = along_s * s.cast<Complex>() * s_part + along_p * d_out.cross(s).cast<Complex>() * p_part;
  }

  void trace_sector(const Order& order, Sector& sector) const {
    Field field;
    field.col(0) = right_.cast<Complex>();
    field.col(1) = up_.cast<Complex>();
    const double n = cube_.index;
    Vec3 d = inside_direction();
    const double c_air = to_source_.z();
    double c = -d.z();
    resolve(-to_source_, d, Vec3::UnitZ(), 2.0 * c_air / (c_air + n * c) * std::sqrt(n * c / c_air),
            2.0 * c_air / (n * c_air + c) * std::sqrt(n * c / c_air), field);
    for (const int facet : order) {
      const Vec3& normal = normals_[static_cast<std::size_t>(facet)];
      c = -normal.dot(d);
      const Complex outer = cube_.metal.value_or(1.0);
      Complex root = std::sqrt(outer * outer - n * n * (1.0 - c * c));
      if (root.imag() < 0.0) root = -root;
      const Vec3 after = d + 2.0 * c * normal;
      resolve(d, after, normal, (n * c - root) / (n * c + root),
              (outer * outer * c - n * root) / (outer * outer * c + n * root), field);
      d = after;
    }
    const Vec2 cosines = n * d.head<2>();
    const Vec3 out(cosines.x(), cosines.y(), std::sqrt(1.0 - cosines.squaredNorm()));
    resolve(d, out, Vec3::UnitZ(), 2.0 * n * d.z() / (n * d.z() + out.z()) * std::sqrt(out.z() / (n * d.z())),
            2.0 * n * d.z() / (d.z() + n * out.z()) * std::sqrt(out.z() / (n * d.z())), field);
    sector.cosines = cosines;
    sector.jones.row(0) = right_.transpose().cast<Complex>() * field;
    sector.jones.row(1) = up_.transpose().cast<Complex>() * field;
    // At the apex, the waves of all sectors have the same phase. From there, each wave is propagated to the entrance
    // face along the direction of the light in an ideal cube. The point at which this line meets the face is the centre
    // of the sector's pattern.
    const Vec3 perfect = -inside_direction();
    const Vec3 to_face = (cube_.thickness_mm - apex_.z()) / perfect.z() * perfect;
    const double k0 = 2.0 * std::numbers::pi / (1e-6 * cube_.wavelength_nm);
    const Vec2 face = apex_.head<2>() + to_face.head<2>();
    sector.phase = std::polar(1.0, k0 * (n * d.dot(to_face) - n * perfect.dot(to_face) - cosines.dot(face)));
    sector.phase *= std::polar(1.0, k0 * to_source_.head<2>().dot(face));
  }

  SectorCube cube_;
  int pixels_;
  double edge_;
  double step_mm_ = 0.0;
  std::array<Vec3, 3> edges_;
  std::array<Vec3, 3> normals_;
  Vec3 to_source_, right_, up_, apex_;
  std::map<Order, Sector> sectors_;
};

}  // namespace retrace::testing
