#include "surface_models/scatter/slope_distribution.h"

#include <numbers>
#include <string>

#include "core/error.h"
#include "core/number_format.h"

namespace retrace::surface_models {
namespace {

using std::numbers::pi;

double tangent(const Vec3& direction) {
  return direction.head<2>().norm() / std::abs(direction.z());
}

/// Draws the slope, towards the light, of a visible facet of a surface with Gaussian slopes of standard deviation 1.
/// The density of the slope p is proportional to N(p) max(0, cos + sin p), where N is the normal density. Proposals are
/// drawn from N(p) (cos + sin max(0, p)), which is an upper bound, and accepted with the ratio.
double visible_gaussian_slope(double cos_light, double sin_light, RandomStream& random) {
  const double rising = sin_light / std::sqrt(2.0 * pi);  // integral of sin p N(p) over p > 0
  for (;;) {
    const bool from_rising = random.next() * (cos_light + rising) >= cos_light;
    if (from_rising) return std::sqrt(-2.0 * std::log1p(-random.next()));
    const double p = normal_pair(random).x();
    if (p >= 0.0 || random.next() * cos_light < cos_light + sin_light * p) return p;
  }
}

/// Draws a visible normal of the GGX distribution (Heitz, Sampling the GGX Distribution of Visible Normals, J. Computer
/// Graphics Techniques 7(4), 1 (2018)).
Vec3 visible_ggx_normal(const Vec3& towards_light, double width, RandomStream& random) {
  const Vec3 stretched = Vec3(width * towards_light.x(), width * towards_light.y(), towards_light.z()).normalized();
  const double across = stretched.head<2>().norm();
  const Vec3 first = across > 0.0 ? Vec3(-stretched.y() / across, stretched.x() / across, 0.0) : Vec3(Vec3::UnitX());
  const Vec3 second = stretched.cross(first);
  const double radius = std::sqrt(random.next());
  const double angle = 2.0 * pi * random.next();
  const double along_first = radius * std::cos(angle);
  const double share = 0.5 * (1.0 + stretched.z());
  const double along_second =
      (1.0 - share) * std::sqrt(std::max(0.0, 1.0 - along_first * along_first)) + share * radius * std::sin(angle);
  const double along_light = std::sqrt(std::max(0.0, 1.0 - along_first * along_first - along_second * along_second));
  const Vec3 normal = along_first * first + along_second * second + along_light * stretched;
  return Vec3(width * normal.x(), width * normal.y(), std::max(1e-12, normal.z())).normalized();
}

}  // namespace

void require_slope_in_range(double rms_slope, const char* what) {
  if (rms_slope > kMaxModelledSlope)
    throw InputError(std::string("the rms slope of the ") + what + " must be at most " + shortest(kMaxModelledSlope) +
                     ", because no scatter model is valid for steeper surfaces, got " +
                     fixed_apart(rms_slope, kMaxModelledSlope, 3));
}

double waviness_rms_slope(double waviness_sq_nm, double waviness_length_um) {
  return waviness_sq_nm > 0.0 ? 2.0 * pi * 1e-3 * waviness_sq_nm / waviness_length_um : 0.0;
}

Vec2 normal_pair(RandomStream& random) {
  const double radius = std::sqrt(-2.0 * std::log1p(-random.next()));
  const double angle = 2.0 * pi * random.next();
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

double SlopeDistribution::normal_density_per_sr(const Vec3& normal) const {
  if (normal.z() <= 0.0 || width_ <= 0.0) return 0.0;
  const double cos2 = normal.z() * normal.z();
  const double scaled2 = (1.0 - cos2) / (cos2 * width_ * width_);
  const double peak = 1.0 / (pi * width_ * width_ * cos2 * cos2);
  if (shape_ == SlopeShape::beckmann) return peak * std::exp(-scaled2);
  return peak / ((1.0 + scaled2) * (1.0 + scaled2));
}

double SlopeDistribution::visible_fraction(const Vec3& direction) const {
  const double tan = tangent(direction);
  if (tan * width_ == 0.0) return 1.0;
  const double a = 1.0 / (width_ * tan);
  if (shape_ == SlopeShape::beckmann)
    return std::min(1.0, 2.0 / (1.0 + std::erf(a) + std::exp(-a * a) / (a * std::sqrt(pi))));
  return 2.0 / (1.0 + std::sqrt(1.0 + 1.0 / (a * a)));
}

Vec3 SlopeDistribution::sample_visible_normal(const Vec3& towards_light, RandomStream& random) const {
  if (width_ <= 0.0) return Vec3::UnitZ();
  if (shape_ == SlopeShape::ggx) return visible_ggx_normal(towards_light, width_, random);
  const double sin_light = towards_light.head<2>().norm();
  const Vec2 towards = sin_light > 0.0 ? Vec2(towards_light.head<2>() / sin_light) : Vec2(Vec2::UnitX());
  const double deviation = width_ / std::sqrt(2.0);  // along one axis
  const double along = deviation * visible_gaussian_slope(towards_light.z(), sin_light * deviation, random);
  const double across = deviation * normal_pair(random).x();
  return Vec3(along * towards.x() - across * towards.y(), along * towards.y() + across * towards.x(), 1.0).normalized();
}

double SlopeDistribution::visible_normal_pdf_per_sr(const Vec3& towards_light, const Vec3& normal) const {
  return visible_fraction(towards_light) * std::max(0.0, towards_light.dot(normal)) * normal_density_per_sr(normal) /
         towards_light.z();
}

}  // namespace retrace::surface_models
