#pragma once

// Internal to studies/rays/io: sizes of what a TM-25 file consists of, in bytes.

#include <cstddef>
#include <cstdint>

namespace retrace::studies::tm25 {

inline constexpr std::int32_t kFormatVersion = 2013;
inline constexpr std::size_t kDateBytes = 28;
inline constexpr std::size_t kReservedBytes = 168;  ///< at the end of the first block
inline constexpr std::size_t kTextBytes = 4000;     ///< of each description
inline constexpr std::size_t kLabelBytes = 512;     ///< of the name of an additional item
inline constexpr std::size_t kBlockBytes = 32;      ///< spectral tables, and the additional text, fill a multiple
inline constexpr std::uint64_t kTotalsAt = 12;      ///< luminous flux, radiant flux, number of rays
inline constexpr std::uint64_t kRangeAt = 68;       ///< least and greatest wavelength

}  // namespace retrace::studies::tm25
