#pragma once

// The ledger: the accounts in which all incident power ends, with their names in files.

#include <array>
#include <cstddef>
#include <string_view>

namespace retrace::raytrace {

/// Where incident power ends. Every bit of it is in exactly one account, and they add to 1.
enum class Account : std::size_t {
  retroreflected,      ///< left through the entrance face inside the acceptance cone
  front_specular,      ///< reflected by the entrance face from outside, outside the cone
  scattered_out,       ///< left through the entrance face outside the cone after a non-specular event
  returned_elsewhere,  ///< the rest that left through the entrance face
  side_exit,           ///< left through sides and border walls
  transmitted,         ///< left through facets, inner walls and flat backs
  absorbed,
  truncated,  ///< below the weight cut-off or past the bounce cap
  lost        ///< missed every face from inside: 0 in a sound run
};

inline constexpr std::size_t kAccountCount = 9;

/// `lost` above which a run counts as unsound.
inline constexpr double kLostLimit = 1e-9;

/// The accounts' names in files, in the order of the enumeration.
inline constexpr std::array<std::string_view, kAccountCount> kAccountNames = {
    "retroreflected", "front_specular", "scattered_out", "returned_elsewhere", "side_exit", "transmitted",
    "absorbed",       "truncated",      "lost"};

/// Power by account, as a share of the incident power.
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
