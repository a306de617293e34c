#include "tests/support/reference_tracer.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <vector>

namespace retrace::testing {
namespace {

using Vec3 = Eigen::Vector3d;
using Vec3c = Eigen::Vector3cd;
using Complex = std::complex<double>;
using geometry::FacetRole;
using raytrace::Account;
using raytrace::Ledger;

constexpr double kMinDistance = 1e-9;
constexpr double kMinPower = 1e-5;
constexpr int kBatches = 32;

struct Ray {
  Vec3 origin;
  Vec3 direction;
  std::array<Vec3c, 2> field;  ///< fields of two orthogonal incoherent inputs
  double flux = 1.0;           ///< power at unit field strength
  bool inside = false;
  bool entered = false;
  /// Role of the face through which the ray last left the part. Before the ray has entered the part, it is the role of
  /// the first face that the ray meets.
  FacetRole left_through = FacetRole::entrance;
  bool has_met = false;  ///< true if the ray has met a face

  double power() const { return 0.5 * flux * (field[0].squaredNorm() + field[1].squaredNorm()); }
};

struct Triangle {
  Vec3 a, ab, ac, normal;
  FacetRole role;
};

/// Sphere around a triangle. A ray that misses the sphere misses the triangle. This test is several times faster than
/// that of the triangle.
struct Sphere {
  double x, y, z, radius2;

  Sphere(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 centre = (a + b + c) / 3.0;
    x = centre.x();
    y = centre.y();
    z = centre.z();
    const double exact = std::max({(a - centre).squaredNorm(), (b - centre).squaredNorm(), (c - centre).squaredNorm()});
    radius2 = 1.001 * exact + 1e-9;  // more than rounding errors
  }
  bool is_missed(const Vec3& origin, const Vec3& direction) const {
    const double dx = x - origin.x(), dy = y - origin.y(), dz = z - origin.z();
    const double along = dx * direction.x() + dy * direction.y() + dz * direction.z();
    return dx * dx + dy * dy + dz * dz - along * along > radius2;
  }
};

class Reference {
 public:
  Reference(const geometry::Part& part, const raytrace::Optics& optics, const Vec3& to_source,
            const raytrace::Stokes& stokes, double cone_rad, Polarisation polarisation)
      : optics_(optics), to_source_(to_source), stokes_in_(stokes), cone_rad_(cone_rad), polarisation_(polarisation) {
    const geometry::BoundaryMesh mesh = geometry::closed_boundary(part);
    for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
      const auto& t = mesh.triangles[k];
      const Vec3 a = mesh.vertices[t[0]];
      const Vec3 ab = mesh.vertices[t[1]] - a;
      const Vec3 ac = mesh.vertices[t[2]] - a;
      triangles_.push_back({a, ab, ac, ab.cross(ac).normalized(), mesh.roles[k]});
      spheres_.emplace_back(a, a + ab, a + ac);
    }
  }

  Ledger trace(const Vec3& entry) {
    ledger_ = Ledger{};
    stokes_ = {};
    Ray ray;
    ray.direction = -to_source_;
    ray.origin = entry + to_source_;
    ray.field = incident_fields();
    follow(ray);
    return ledger_;
  }
  const std::array<double, 4>& stokes() const { return stokes_; }

  ReferenceRay trace(const Vec3& origin, const Vec3& direction, const raytrace::Light& light, bool inside) {
    ledger_ = Ledger{};
    exits_.clear();
    to_source_ = -direction;
    Ray ray;
    ray.direction = direction;
    ray.origin = origin;
    const raytrace::Stokes& s = light.stokes;
    ray.field = fields_of({s.i, s.q, -s.u, s.v}, {light.s_axis, -direction.cross(light.s_axis)});
    ray.inside = ray.entered = inside;
    double t = 0.0;
    const bool meets = nearest(ray, t) != nullptr;
    if (meets) follow(ray);
    return {meets, ledger_, exits_};
  }

 private:
  /// Returns the two axes of polarisation, which are perpendicular to the direction to the source. The first axis is
  /// the projection of +x. The second axis is the cross product of the direction to the source and the first axis.
  static std::array<Vec3, 2> axes_of(const Vec3& to_source) {
    const Vec3 first = (Vec3::UnitX() - to_source.x() * to_source).normalized();
    return {first, to_source.cross(first)};
  }

  /// Returns two orthogonal incoherent fields whose sum is the incident light: the eigenvectors of its coherency
  /// matrix.
  std::array<Vec3c, 2> incident_fields() const { return fields_of(stokes_in_, axes_of(to_source_)); }

  static std::array<Vec3c, 2> fields_of(const raytrace::Stokes& stokes, const std::array<Vec3, 2>& axes) {
    const auto& [i, q, u, v] = stokes;
    // The light propagates along -to_source. A rotation that the receiver sees as clockwise leads from the first to the
    // second axis.
    Eigen::Matrix2cd coherency;
    coherency << Complex(i + q), Complex(u, -v), Complex(u, v), Complex(i - q);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2cd> solver(coherency);
    std::array<Vec3c, 2> fields;
    for (Eigen::Index k = 0; k < 2; ++k) {
      const Eigen::Vector2cd a = std::sqrt(std::max(0.0, solver.eigenvalues()[k])) * solver.eigenvectors().col(k);
      fields[static_cast<std::size_t>(k)] = a[0] * axes[0].cast<Complex>() + a[1] * axes[1].cast<Complex>();
    }
    return fields;
  }

  const Triangle* nearest(const Ray& ray, double& t_hit) const {
    const Triangle* hit = nullptr;
    t_hit = INFINITY;
    for (std::size_t k = 0; k < triangles_.size(); ++k) {
      if (spheres_[k].is_missed(ray.origin, ray.direction)) continue;
      const Triangle& tri = triangles_[k];
      const Vec3 p = ray.direction.cross(tri.ac);
      const double det = tri.ab.dot(p);
      if (det == 0.0) continue;
      const Vec3 s = ray.origin - tri.a;
      const double u = s.dot(p) / det;
      if (u < 0.0 || u > 1.0) continue;
      const Vec3 q = s.cross(tri.ab);
      const double v = ray.direction.dot(q) / det;
      const double t = tri.ac.dot(q) / det;
      if (v < 0.0 || u + v > 1.0 || t < kMinDistance || t >= t_hit) continue;
      t_hit = t;
      hit = &tri;
    }
    return hit;
  }

  void follow(Ray ray) {
    if (ray.power() < kMinPower) {
      ledger_[Account::truncated] += ray.power();
      return;
    }
    double t = 0.0;
    const Triangle* hit = nearest(ray, t);
    if (hit == nullptr) {
      book_exit(ray);
      return;
    }
    if (ray.inside && optics_.absorption_per_mm > 0.0) {
      const double kept = std::exp(-optics_.absorption_per_mm * t);
      ledger_[Account::absorbed] += ray.power() * (1.0 - kept);
      ray.flux *= kept;
    }
    ray.origin += t * ray.direction;
    interface(ray, *hit);
  }

  void interface(Ray ray, const Triangle& hit) {
    if (polarisation_ == Polarisation::averaged) {
      const double strength = std::sqrt(0.5 * (ray.field[0].squaredNorm() + ray.field[1].squaredNorm()));
      const Vec3 first = ray.direction.unitOrthogonal();
      ray.field = {strength * first.cast<Complex>(), strength * ray.direction.cross(first).cast<Complex>()};
    }
    const Vec3 n = hit.normal.dot(ray.direction) > 0.0 ? Vec3(-hit.normal) : hit.normal;
    const bool is_wall = hit.role == FacetRole::border_wall || hit.role == FacetRole::inner_wall;
    if (is_wall && optics_.absorbing_walls) {
      ledger_[Account::absorbed] += ray.power();
      return;
    }
    const bool in_front = hit.role == FacetRole::entrance || hit.role == FacetRole::side;
    const double outside = in_front ? 1.0 : optics_.back_index;
    const double n1 = ray.inside ? optics_.index : outside;
    const double n2 = ray.inside ? outside : optics_.index;
    const double ci = -n.dot(ray.direction);
    const bool is_retro = hit.role == FacetRole::retro_facet;
    const bool is_entrance = hit.role == FacetRole::entrance;
    if ((is_retro && !optics_.facet_layers.empty()) || (is_entrance && !optics_.entrance_layers.empty())) {
      meet_layers(ray, hit.role, n, n1, n2, (is_retro ? optics_.facet_layers : optics_.entrance_layers).layers);
      return;
    }
    const double sin_t = n1 / n2 * std::sqrt(std::max(0.0, 1.0 - ci * ci));
    const Complex ct = std::sqrt(Complex(1.0 - sin_t * sin_t, 0.0));
    const Complex r_s = (n1 * ci - n2 * ct) / (n1 * ci + n2 * ct);
    const Complex r_p = (n2 * ci - n1 * ct) / (n2 * ci + n1 * ct);
    Vec3 s = n.cross(ray.direction);
    s = s.norm() > 1e-9 ? s.normalized() : ray.direction.unitOrthogonal();

    Ray mirrored = ray;
    mirrored.direction = (ray.direction + 2.0 * ci * n).normalized();
    mirrored.field = recombined(ray, mirrored.direction, s, r_s, r_p);
    if (!ray.entered && !ray.has_met) mirrored.left_through = hit.role;
    mirrored.has_met = true;
    follow(mirrored);
    if (sin_t >= 1.0) return;

    Ray through = ray;
    through.direction = (n1 / n2 * ray.direction + (n1 / n2 * ci - ct.real()) * n).normalized();
    through.field =
        recombined(ray, through.direction, s, 2.0 * n1 * ci / (n1 * ci + n2 * ct), 2.0 * n1 * ci / (n2 * ci + n1 * ct));
    through.flux *= n2 * ct.real() / (n1 * ci);
    through.inside = !ray.inside;
    through.entered = true;
    if (ray.inside) through.left_through = hit.role;
    follow(through);
  }

  struct Amplitudes {
    Complex r, t;
  };
  /// Returns the amplitudes that a stack of layers reflects and transmits: of the electric field for s, and of the
  /// magnetic field for p. They are computed recursively from the last medium to the first. The recursion uses normal
  /// wave numbers instead of angles of refraction.
  /// \param indices refractive indices of all media, including the first and the last
  /// \param waves thicknesses of the layers in wavelengths
  static Amplitudes amplitudes(const std::vector<Complex>& indices, const std::vector<double>& waves, double ci,
                               bool is_p) {
    const Complex tangential = indices[0] * std::sqrt(std::max(0.0, 1.0 - ci * ci));
    const auto kz = [&](std::size_t k) {
      const Complex root = std::sqrt(indices[k] * indices[k] - tangential * tangential);
      return root.imag() < 0.0 ? -root : root;
    };
    Amplitudes sum{0.0, 1.0};
    for (std::size_t k = indices.size() - 1; k-- > 0;) {
      const Complex a = kz(k) * (is_p ? indices[k + 1] * indices[k + 1] : 1.0);
      const Complex b = kz(k + 1) * (is_p ? indices[k] * indices[k] : 1.0);
      const Complex r = (a - b) / (a + b);
      const bool is_last = k + 2 == indices.size();
      const Complex once = is_last ? 1.0 : std::exp(Complex(0.0, 2.0 * std::numbers::pi * waves[k + 1]) * kz(k + 1));
      const Complex loop = 1.0 + r * sum.r * once * once;
      sum = {(r + sum.r * once * once) / loop, (1.0 + r) * sum.t * once / loop};
    }
    return sum;
  }

  void meet_layers(Ray ray, FacetRole role, const Vec3& n, double n1, double n2,
                   std::vector<materials::ThinLayer> layers) {
    if (!ray.inside) std::reverse(layers.begin(), layers.end());
    std::vector<Complex> indices = {n1};
    std::vector<double> waves = {0.0};
    bool is_opaque = false;
    for (const materials::ThinLayer& layer : layers) {
      indices.push_back(layer.index);
      waves.push_back(layer.thickness);
      is_opaque = std::isinf(layer.thickness);
      if (is_opaque) break;
    }
    if (!is_opaque) indices.push_back(n2);
    const double ci = -n.dot(ray.direction);
    const Amplitudes of_s = amplitudes(indices, waves, ci, false);
    const Amplitudes of_p = amplitudes(indices, waves, ci, true);
    Vec3 s = n.cross(ray.direction);
    s = s.norm() > 1e-9 ? s.normalized() : ray.direction.unitOrthogonal();
    Ray mirrored = ray;
    mirrored.direction = (ray.direction + 2.0 * ci * n).normalized();
    mirrored.field = recombined(ray, mirrored.direction, s, of_s.r, of_p.r);
    const double sin_t = n1 / n2 * std::sqrt(std::max(0.0, 1.0 - ci * ci));
    const bool passes = !is_opaque && sin_t < 1.0;
    Ray through = ray;
    if (passes) {
      const double ct = std::sqrt(1.0 - sin_t * sin_t);
      through.direction = (n1 / n2 * ray.direction + (n1 / n2 * ci - ct) * n).normalized();
      through.field = recombined(ray, through.direction, s, of_s.t, of_p.t * n1 / n2);
      through.flux *= n2 * ct / (n1 * ci);
      through.inside = !ray.inside;
      through.entered = true;
      if (ray.inside) through.left_through = role;
    }
    ledger_[Account::absorbed] += ray.power() - mirrored.power() - (passes ? through.power() : 0.0);
    follow(mirrored);
    if (passes) follow(through);
  }

  /// Returns the field after an interface. The direction of s is unchanged, and the direction of p rotates with the
  /// ray.
  static std::array<Vec3c, 2> recombined(const Ray& ray, const Vec3& direction, const Vec3& s, Complex c_s,
                                         Complex c_p) {
    const Vec3 p_in = s.cross(ray.direction);
    const Vec3 p_out = s.cross(direction);
    std::array<Vec3c, 2> field;
    for (std::size_t k = 0; k < 2; ++k) {
      const Complex along_s = s.cast<Complex>().dot(ray.field[k]);
      const Complex along_p = p_in.cast<Complex>().dot(ray.field[k]);
      field[k] = c_s * along_s * s.cast<Complex>() + c_p * along_p * p_out.cast<Complex>();
    }
    return field;
  }

  void book_exit(const Ray& ray) {
    if (ray.inside) {
      ledger_[Account::lost] += ray.power();
      return;
    }
    const double angle = std::atan2(ray.direction.cross(to_source_).norm(), ray.direction.dot(to_source_));
    const bool in_cone = angle <= cone_rad_ * (1.0 + 1e-9);
    const bool side = ray.left_through == FacetRole::side || ray.left_through == FacetRole::border_wall;
    Account account = side ? Account::side_exit : Account::transmitted;
    if (ray.left_through == FacetRole::entrance) {
      account = ray.entered ? Account::returned_elsewhere : Account::front_specular;
      if (in_cone) account = Account::retroreflected;
      if (in_cone) add_stokes(ray);
    }
    ledger_[account] += ray.power();
    Eigen::Matrix3cd coherency = Eigen::Matrix3cd::Zero();
    for (const Vec3c& field : ray.field) coherency += 0.5 * ray.flux * field * field.adjoint();
    exits_.push_back({account, ray.origin, ray.direction, coherency});
  }

  void add_stokes(const Ray& ray) {
    const auto axes = axes_of(ray.direction);
    for (const Vec3c& field : ray.field) {
      const Complex a = axes[0].cast<Complex>().dot(field);
      const Complex b = axes[1].cast<Complex>().dot(field);
      const Complex cross = a * std::conj(b);
      const std::array<double, 4> one = {std::norm(a) + std::norm(b), std::norm(a) - std::norm(b), 2.0 * cross.real(),
                                         2.0 * cross.imag()};
      for (std::size_t k = 0; k < 4; ++k) stokes_[k] += 0.5 * ray.flux * one[k];
    }
  }

  raytrace::Optics optics_;
  Vec3 to_source_;
  raytrace::Stokes stokes_in_;
  double cone_rad_;
  Polarisation polarisation_;
  std::array<double, 4> stokes_{};
  std::vector<Triangle> triangles_;
  std::vector<Sphere> spheres_;  ///< one for each triangle
  Ledger ledger_;
  std::vector<ReferenceExit> exits_;
};

/// Returns a random point of the entrance face, by rejection sampling from its bounding box.
geometry::Vec2 random_point(const geometry::Part& part, std::mt19937_64& generator) {
  const geometry::Rectangle box = geometry::bounding_box(part.outline);
  const std::vector<geometry::Polygon> pieces = geometry::entrance_polygons(part);
  std::uniform_real_distribution<double> x(box.lower.x(), box.upper.x());
  std::uniform_real_distribution<double> y(box.lower.y(), box.upper.y());
  for (;;) {
    const geometry::Vec2 p(x(generator), y(generator));
    for (const geometry::Polygon& outline : pieces) {
      bool inside = true;
      for (std::size_t k = 0; k < outline.size(); ++k) {
        const geometry::Vec2 along = outline[(k + 1) % outline.size()] - outline[k];
        const geometry::Vec2 to = p - outline[k];
        inside = inside && along.x() * to.y() - along.y() * to.x() > 0.0;
      }
      if (inside) return p;
    }
  }
}

}  // namespace

ReferenceResult reference_trace(const geometry::Part& part, const raytrace::Optics& optics,
                                const raytrace::Illumination& illumination, double cone_half_angle_deg,
                                std::uint64_t rays, std::uint64_t seed, Polarisation polarisation) {
  const double t = illumination.incidence.rad();
  const double p = illumination.azimuth.rad();
  Reference reference(part, optics, Vec3(std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t)),
                      illumination.stokes, Angle::from_deg(cone_half_angle_deg).rad(), polarisation);
  std::mt19937_64 generator(seed);
  std::array<Ledger, kBatches> batches{};
  std::array<std::array<double, 4>, kBatches> stokes{};
  const std::uint64_t per_batch = rays / kBatches;
  for (std::size_t b = 0; b < kBatches; ++b)
    for (std::uint64_t k = 0; k < per_batch; ++k) {
      const geometry::Vec2 at = random_point(part, generator);
      const Ledger one = reference.trace({at.x(), at.y(), part.thickness_mm});
      for (std::size_t a = 0; a < raytrace::kAccountCount; ++a)
        batches[b].power[a] += one.power[a] / static_cast<double>(per_batch);
      for (std::size_t a = 0; a < 4; ++a) stokes[b][a] += reference.stokes()[a] / static_cast<double>(per_batch);
    }
  ReferenceResult result;
  for (std::size_t a = 0; a < 4; ++a) {
    double squares = 0.0;
    for (const auto& batch : stokes) result.stokes[a] += batch[a] / kBatches;
    for (const auto& batch : stokes) squares += std::pow(batch[a] - result.stokes[a], 2.0);
    result.stokes_error[a] = std::sqrt(squares / (kBatches * (kBatches - 1.0)));
  }
  for (std::size_t a = 0; a < raytrace::kAccountCount; ++a) {
    double squares = 0.0;
    for (const Ledger& batch : batches) result.mean.power[a] += batch.power[a] / kBatches;
    for (const Ledger& batch : batches) squares += std::pow(batch.power[a] - result.mean.power[a], 2.0);
    result.std_error[a] = std::sqrt(squares / (kBatches * (kBatches - 1.0)));
  }
  return result;
}

std::array<double, 4> ReferenceExit::stokes(const Eigen::Vector3d& axis) const {
  const Eigen::Vector3cd a = axis.cast<Complex>();
  const Eigen::Vector3cd b = direction.cross(axis).cast<Complex>();
  const double along_a = a.dot(coherency * a).real();
  const double along_b = b.dot(coherency * b).real();
  const Complex cross = 2.0 * a.dot(coherency * b);
  return {along_a + along_b, along_a - along_b, cross.real(), cross.imag()};
}

ReferenceRay reference_ray(const geometry::Part& part, const raytrace::Optics& optics, const Eigen::Vector3d& origin_mm,
                           const Eigen::Vector3d& direction, const raytrace::Light& light, bool inside,
                           double cone_half_angle_deg) {
  Reference reference(part, optics, -direction, raytrace::kUnpolarised, Angle::from_deg(cone_half_angle_deg).rad(),
                      Polarisation::kept);
  return reference.trace(origin_mm, direction, light, inside);
}

}  // namespace retrace::testing
