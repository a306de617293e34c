#pragma once

// The ledger: the accounts for all incident power, with their names in files.

#include <array>
#include <cstddef>
#include <string_view>

namespace retrace::raytrace {

/// Accounts for incident power. All power ends in exactly one account, and the accounts add up to 1.
enum class Account : std::size_t {
  retroreflected,      ///< left through the entrance face inside the acceptance cone
  front_specular,      ///< reflected by the entrance face from outside, outside the cone
  scattered_out,       ///< left through the entrance face outside the cone after a non-specular event
  returned_elsewhere,  ///< other light that left through the entrance face
  side_exit,           ///< left through sides and border walls
  transmitted,         ///< left through facets, inner walls and flat parts of the back
  absorbed,
  truncated,  ///< not traced further: power below the cut-off, or too many interfaces
  lost,       ///< missed every face although it was inside the part; 0 unless there is a defect
  /// reflected at surfaces of shells (separate lenses in front of the part), and not traced further; 0 without shells
  shell_reflected,
  stopped  ///< blocked by the mount or by the chamfer of the entrance face; 0 without mount and chamfer
};

inline constexpr std::size_t kAccountCount = 11;

/// Maximum `lost` power of a valid run.
inline constexpr double kLostLimit = 1e-9;

/// Names of the accounts in files, in the order of the enumeration.
inline constexpr std::array<std::string_view, kAccountCount> kAccountNames = {
    "retroreflected", "front_specular", "scattered_out", "returned_elsewhere", "side_exit", "transmitted",
    "absorbed",       "truncated",      "lost",          "shell_reflected",    "stopped"};

/// Returns true if result files list an account. The accounts `shell_reflected` and `stopped` are listed only if their
/// power is not 0. All other accounts are always listed.
constexpr bool is_listed(Account account, double power) {
  return (account != Account::shell_reflected && account != Account::stopped) || power != 0.0;
}

/// Power by account, as a fraction of the incident power.
struct Ledger {
  std::array<double, kAccountCount> power{};

  double& operator[](Account a) { return power[static_cast<std::size_t>(a)]; }
  double operator[](Account a) const { return power[static_cast<std::size_t>(a)]; }
  double total() const {
    double sum = 0.0;
    for (const double p : power) sum += p;
    return sum;
  }
};

}  // namespace retrace::raytrace
