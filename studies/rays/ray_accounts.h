#pragma once

// Accounts of rays, with their names in files: the accounts of the ledger, and one for rays that miss the part.

#include <array>
#include <cstddef>
#include <string_view>

#include "raytrace/light/ledger.h"

namespace retrace::studies {

/// Number of the account for rays that miss the part. It reuses the number of raytrace::Account::shell_reflected. Rays
/// do not need that account, because light that shells reflect is not traced further.
inline constexpr auto kMissedAccount = static_cast<std::size_t>(raytrace::Account::shell_reflected);

/// Names of the accounts to which rays can belong, in the order of their numbers. The ledger has further accounts for
/// light that is not traced as rays. These accounts are 0 for most parts.
inline constexpr std::array<std::string_view, kMissedAccount + 1> kRayAccounts = [] {
  std::array<std::string_view, kMissedAccount + 1> names;
  for (std::size_t k = 0; k < kMissedAccount; ++k) names[k] = raytrace::kAccountNames[k];
  names[kMissedAccount] = "missed";
  return names;
}();

}  // namespace retrace::studies
