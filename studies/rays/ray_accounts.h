#pragma once

// The accounts of rays, with their names in files: those of the ledger, and that of rays that miss the part.

#include <array>
#include <cstddef>
#include <string_view>

#include "raytrace/light/ledger.h"

namespace retrace::studies {

inline constexpr std::size_t kMissedAccount = raytrace::kAccountCount;

inline constexpr std::array<std::string_view, raytrace::kAccountCount + 1> kRayAccounts = [] {
  std::array<std::string_view, raytrace::kAccountCount + 1> names;
  for (std::size_t k = 0; k < raytrace::kAccountCount; ++k) names[k] = raytrace::kAccountNames[k];
  names[kMissedAccount] = "missed";
  return names;
}();

}  // namespace retrace::studies
