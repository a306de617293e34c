#pragma once

// Sets of rays as files hold them: what is told of all rays, and of each.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "geometry/vec.h"
#include "materials/spectrum.h"

namespace retrace::studies {

using geometry::Vec3;

/// How a set tells the wavelengths of its rays; the numbers are those of TM-25.
enum class RaySpectrum : std::int32_t {
  unknown = 0,
  one_wavelength = 1,
  wavelength_of_each = 2,
  one_table = 3,
  table_of_each = 4
};

/// Of what a set says of its origin, in the order of TM-25.
enum class RayText : std::size_t {
  light_source,
  manufacturer,
  model_creator,
  file_creator,
  equipment,
  camera,
  operation,
  more,
  geometry
};
inline constexpr std::size_t kRayTexts = 9;

/// What is told of all rays of a set.
struct RaySetInfo {
  std::optional<std::uint64_t> rays;  ///< none: not known before they are read
  bool has_radiant = true;            ///< radiant flux, in W
  bool has_luminous = false;          ///< luminous flux, in lm; one of the two at least
  bool has_tristimulus = false;       ///< X and Z beside the luminous flux
  bool has_stokes = false;
  RaySpectrum spectrum = RaySpectrum::unknown;
  double wavelength_nm = 0.0;                    ///< of RaySpectrum::one_wavelength
  std::vector<materials::SpectralCurve> tables;  ///< relative power per nm
  std::optional<double> radiant_w;               ///< of all rays together, as the set says
  std::optional<double> luminous_lm;
  std::string date;                             ///< as given; empty: none
  std::array<std::u32string, kRayTexts> texts;  ///< empty: unknown
  std::vector<std::string> more_items;          ///< names of what else the set holds of each ray

  const std::u32string& text(RayText which) const { return texts[static_cast<std::size_t>(which)]; }
  std::u32string& text(RayText which) { return texts[static_cast<std::size_t>(which)]; }
};

/// One ray of a set. What the set does not hold stays as it is here.
struct SetRay {
  Vec3 position_mm = Vec3::Zero();
  Vec3 direction = Vec3::UnitZ();  ///< unit
  double radiant_w = 0.0;
  double luminous_lm = 0.0;
  double tristimulus_x = 0.0;
  double tristimulus_z = 0.0;
  std::array<double, 3> stokes = {};  ///< S1, S2 and S3 over the power, along `axis` and direction x axis
  Vec3 axis = Vec3::UnitX();          ///< across the direction
  double wavelength_nm = 0.0;
  std::uint32_t table = 0;  ///< which one of the tables, from 1
};

/// A ray that has left a part, or missed it, with its account.
struct AccountedRay : SetRay {
  std::uint64_t number = 0;  ///< of the ray that it comes from, from 1
  std::size_t account = 0;   ///< in kRayAccounts
};

}  // namespace retrace::studies
