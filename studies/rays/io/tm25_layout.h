#pragma once

// Sizes and positions, in bytes, of the components of a TM-25 file. Internal to studies/rays/io.

#include <cstddef>
#include <cstdint>

namespace retrace::studies::tm25 {

inline constexpr std::int32_t kFormatVersion = 2013;
inline constexpr std::size_t kDateBytes = 28;
inline constexpr std::size_t kReservedBytes = 168;  ///< size of the reserved space at the end of the first block
inline constexpr std::size_t kTextBytes = 4000;     ///< size of each description
inline constexpr std::size_t kLabelBytes = 512;     ///< size of the name of an additional item
inline constexpr std::size_t kBlockBytes = 32;      ///< unit of the size of spectral tables and of the additional text
inline constexpr std::uint64_t kTotalsAt = 12;      ///< position of luminous flux, radiant flux and number of rays
inline constexpr std::uint64_t kRangeAt = 68;       ///< position of the minimum and maximum wavelength

}  // namespace retrace::studies::tm25
