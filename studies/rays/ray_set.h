#pragma once

// Contents of ray files: data of the whole set and of each ray.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "geometry/vec.h"
#include "materials/spectrum.h"

namespace retrace::studies {

using geometry::Vec3;

/// Kind of wavelength data in a set. The numbers are those of the TM-25 format.
enum class RaySpectrum : std::int32_t {
  unknown = 0,
  one_wavelength = 1,
  wavelength_of_each = 2,
  one_table = 3,
  table_of_each = 4
};

/// Texts that describe a set of rays, in the order of the TM-25 format.
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

/// Data of the whole set of rays.
struct RaySetInfo {
  std::optional<std::uint64_t> rays;  ///< number of rays; none: not known before they are read
  bool has_radiant = true;            ///< rays have radiant flux, in W
  bool has_luminous = false;          ///< rays have luminous flux, in lm; if false, has_radiant is true
  bool has_tristimulus = false;       ///< rays have the tristimulus values X and Z in addition to the luminous flux
  bool has_stokes = false;
  RaySpectrum spectrum = RaySpectrum::unknown;
  double wavelength_nm = 0.0;                    ///< wavelength of all rays for RaySpectrum::one_wavelength
  std::vector<materials::SpectralCurve> tables;  ///< relative power per nm
  std::optional<double> radiant_w;               ///< total flux that the set claims
  std::optional<double> luminous_lm;
  std::string date;  ///< date as given; empty: none
  /// Descriptions of the set, indexed by RayText; an empty text is unknown.
  std::array<std::u32string, kRayTexts> texts;
  std::vector<std::string> more_items;  ///< names of additional items of each ray

  const std::u32string& text(RayText which) const { return texts[static_cast<std::size_t>(which)]; }
  std::u32string& text(RayText which) { return texts[static_cast<std::size_t>(which)]; }
};

/// Ray of a set. Members that the set does not contain keep these defaults.
struct SetRay {
  Vec3 position_mm = Vec3::Zero();
  Vec3 direction = Vec3::UnitZ();  ///< unit vector
  double radiant_w = 0.0;
  double luminous_lm = 0.0;
  double tristimulus_x = 0.0;
  double tristimulus_z = 0.0;
  /// S1, S2 and S3 divided by the power, in the transverse basis (`axis`, direction x `axis`).
  std::array<double, 3> stokes = {};
  Vec3 axis = Vec3::UnitX();  ///< perpendicular to the direction
  double wavelength_nm = 0.0;
  std::uint32_t table = 0;  ///< number of the spectral table, from 1
};

/// Ray that has left or missed a part, with the account (category) of its power in the ledger.
struct AccountedRay : SetRay {
  std::uint64_t number = 0;  ///< number of the incident ray, from 1
  std::size_t account = 0;   ///< index in kRayAccounts
};

}  // namespace retrace::studies
