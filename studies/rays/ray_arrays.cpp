#include "studies/rays/ray_arrays.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "core/error.h"
#include "studies/rays/ray_limits.h"

namespace retrace::studies {
namespace {

[[noreturn]] void refuse(const char* array, std::size_t ray, const std::string& text) {
  throw InputError({"", 0, array}, fmt::format("ray {}: {}", ray, text));
}

/// Checks the number of values in an array.
/// \param more_may_be other numbers of values that are allowed
void require_size(std::span<const double> values, const char* array, std::size_t size,
                  std::initializer_list<std::size_t> more_may_be = {}) {
  if (values.size() == size || std::ranges::count(more_may_be, values.size()) > 0) return;
  throw InputError({"", 0, array}, fmt::format("must have {} numbers, got {}", size, values.size()));
}

Vec3 three(std::span<const double> values, std::size_t ray, const char* array) {
  const Vec3 v(values[3 * ray], values[3 * ray + 1], values[3 * ray + 2]);
  if (!v.allFinite()) refuse(array, ray, "must be finite numbers");
  return v;
}

/// Reserves memory, in large pages if the system supports them. The system clears each page at its first use. With
/// small pages, this takes longer than filling the memory.
template <class Value>
void reserve_in_large_pages(std::vector<Value>& values, std::size_t count) {
  values.reserve(count);
#ifdef MADV_HUGEPAGE
  const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
  const auto begin = reinterpret_cast<std::uintptr_t>(values.data());
  const std::uintptr_t first = (begin + page - 1) / page * page;
  const std::uintptr_t end = (begin + count * sizeof(Value)) / page * page;
  // madvise() is only a hint, so that errors are ignored.
  if (end > first) ::madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE);
#endif
}

}  // namespace

ArraySource::ArraySource(const RaySpans& arrays) : arrays_(arrays), count_(arrays.origins_mm.size() / 3) {
  require_size(arrays.origins_mm, "origins", 3 * count_);
  require_size(arrays.directions, "directions", 3 * count_);
  require_size(arrays.stokes, "stokes", 4 * count_, {4});
  require_size(arrays.axes, "axes", 3 * count_, {0});
  require_size(arrays.wavelengths_nm, "wavelength_nm", count_, {0, 1});
  info_.rays = count_;
  info_.has_stokes = true;
  if (arrays.wavelengths_nm.empty()) return;
  const bool is_one = arrays.wavelengths_nm.size() == 1;
  info_.spectrum = is_one ? RaySpectrum::one_wavelength : RaySpectrum::wavelength_of_each;
  info_.wavelength_nm = arrays.wavelengths_nm.front();
  for (std::size_t k = 0; k < arrays.wavelengths_nm.size(); ++k)
    if (!is_wavelength(arrays.wavelengths_nm[k])) refuse("wavelength_nm", k, wavelength_text(arrays.wavelengths_nm[k]));
}

double ArraySource::fraction_read() const {
  return count_ > 0 ? static_cast<double>(rays_read_) / static_cast<double>(count_) : 1.0;
}

bool ArraySource::read(std::size_t max_rays, std::vector<SetRay>& rays) {
  rays.clear();
  const std::size_t end = std::min(count_, rays_read_ + max_rays);
  for (; rays_read_ < end; ++rays_read_) {
    rays.push_back(ray(rays_read_));
    if (!total_.add(rays.back())) refuse("stokes", rays_read_, total_power_text(rays.back().radiant_w));
  }
  return !rays.empty();
}

SetRay ArraySource::ray(std::size_t number) const {
  SetRay ray;
  ray.position_mm = three(arrays_.origins_mm, number, "origins");
  const std::optional<Vec3> direction = unit_along(three(arrays_.directions, number, "directions"));
  if (!direction) refuse("directions", number, "the direction must not be the zero vector");
  ray.direction = *direction;
  const std::size_t at = arrays_.stokes.size() == 4 ? 0 : 4 * number;
  ray.radiant_w = arrays_.stokes[at];
  if (!(ray.radiant_w >= 0.0) || !std::isfinite(ray.radiant_w))
    refuse("stokes", number, fmt::format("the power must be >= 0, got {}", ray.radiant_w));
  for (std::size_t k = 0; k < 3; ++k) {
    const double s = arrays_.stokes[at + 1 + k];
    if (!std::isfinite(s)) refuse("stokes", number, "must be finite numbers");
    ray.stokes[k] = ray.radiant_w > 0.0 ? s / ray.radiant_w : 0.0;
  }
  ray.axis = arrays_.axes.empty() ? perpendicular_axis(ray.direction) : three(arrays_.axes, number, "axes");
  if (const char* const wrong = orthogonalize_stokes_axis(ray)) refuse("stokes", number, wrong);
  if (arrays_.wavelengths_nm.size() == count_) ray.wavelength_nm = arrays_.wavelengths_nm[number];
  return ray;
}

ArraySink::ArraySink(std::size_t rays) {
  for (std::vector<double>* const each : {&origins_mm, &directions, &axes}) reserve_in_large_pages(*each, 3 * rays);
  reserve_in_large_pages(stokes, 4 * rays);
  reserve_in_large_pages(wavelengths_nm, rays);
  reserve_in_large_pages(accounts, rays);
  reserve_in_large_pages(incident, rays);
}

void ArraySink::write(std::span<const AccountedRay> rays) {
  for (const AccountedRay& ray : rays) {
    origins_mm.insert(origins_mm.end(), ray.position_mm.begin(), ray.position_mm.end());
    directions.insert(directions.end(), ray.direction.begin(), ray.direction.end());
    stokes.push_back(ray.radiant_w);
    for (const double s : ray.stokes) stokes.push_back(ray.radiant_w * s);
    axes.insert(axes.end(), ray.axis.begin(), ray.axis.end());
    wavelengths_nm.push_back(ray.wavelength_nm);
    accounts.push_back(static_cast<std::uint8_t>(ray.account));
    incident.push_back(ray.number - 1);
  }
}

}  // namespace retrace::studies
