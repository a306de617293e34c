#include "fabrication/check/start_check.h"

#include <fmt/format.h>

#include <bit>
#include <utility>

namespace retrace::fabrication {
namespace {

constexpr std::uint8_t kZBit = 1U << 2U;
constexpr double kStartMm = 2e-6;  // of heights whose words are whole nanometres

}  // namespace

void StartCheck::motion(const NcMotion& motion) {
  const auto foreign = static_cast<std::uint8_t>(motion.moved & ~axes_);
  if (foreign != 0)
    findings_.add(
        "axis_unknown", motion.place.line,
        fmt::format("the machine has no axis {}", kNcAxisLetters[static_cast<std::size_t>(std::countr_zero(foreign))]));
  const auto known = static_cast<std::uint8_t>(motion.known & axes_);
  if (std::exchange(is_first_, false)) {
    if (motion.moved != kZBit || motion.move != NcMove::rapid)
      findings_.add("start", motion.place.line, "the first move is not a rapid one of Z alone");
    else if (motion.to.z_mm < clear_mm_ - kStartMm)
      findings_.add("start", motion.place.line, "the first move does not bring Z above the blank by clear_mm",
                    motion.to.z_mm, clear_mm_);
    return;
  }
  const auto missing = static_cast<std::uint8_t>(axes_ & ~known);
  const bool only_says_where = (motion.moved & known) == 0 && motion.move == NcMove::rapid;
  if (missing != 0 && !only_says_where)
    findings_.add("start", motion.place.line,
                  fmt::format("the tool moves before the program says where {} is",
                              kNcAxisLetters[static_cast<std::size_t>(std::countr_zero(missing))]));
}

}  // namespace retrace::fabrication
