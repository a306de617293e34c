#pragma once

// Reads any bytes as a file of rays. The file is either read or refused with a message of one line. Rays that are read
// can be traced.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "studies/rays/io/ray_input.h"
#include "studies/rays/ray_source.h"

namespace retrace::fuzz {

inline void require(bool holds) {
  if (!holds) std::abort();
}

inline void check_ray(const studies::SetRay& ray) {
  require(ray.position_mm.allFinite() && std::abs(ray.direction.norm() - 1.0) < 1e-9);
  for (const double flux : {ray.radiant_w, ray.luminous_lm, ray.tristimulus_x, ray.tristimulus_z})
    require(std::isfinite(flux) && flux >= 0.0);
  require(std::hypot(ray.stokes[0], ray.stokes[1], ray.stokes[2]) < 1.0 + 1e-3);
  require(std::isfinite(ray.wavelength_nm) && ray.wavelength_nm >= 0.0);
}

template <class Source>
void read_rays(const std::uint8_t* data, std::size_t size, const char* file) {
  constexpr std::size_t kAtATime = 64;
  try {
    studies::RayInput input;
    input.bytes = size;
    input.stream =
        std::make_unique<std::istringstream>(std::string(reinterpret_cast<const char*>(data), size), std::ios::binary);
    Source source(std::move(input), file);
    std::vector<studies::SetRay> rays;
    std::uint64_t count = 0;
    while (source.read(kAtATime, rays)) {
      require(!rays.empty() && rays.size() <= kAtATime);
      for (const studies::SetRay& ray : rays) check_ray(ray);
      count += rays.size();
      require(source.fraction_read() >= 0.0 && source.fraction_read() <= 1.0);
    }
    require(!source.info().rays || *source.info().rays == count);
  } catch (const InputError& error) {
    const std::string_view message = error.what();
    require(!message.empty() &&
            std::none_of(message.begin(), message.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }));
  }
}

}  // namespace retrace::fuzz
