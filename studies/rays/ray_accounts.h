#pragma once

// Accounts of rays, with their names in files: the accounts of the ledger, and one for rays that miss the part.

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
