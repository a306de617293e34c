#include "fabrication/check/known_axes.h"

#include <fmt/format.h>

#include <bit>

namespace retrace::fabrication {
namespace {

char letter_of(std::uint8_t axes) {
  return kNcAxisLetters[static_cast<std::size_t>(std::countr_zero(axes))];
}

}  // namespace

void KnownAxes::motion(const NcMotion& motion) {
  if (const auto foreign = static_cast<std::uint8_t>(motion.moved & ~axes_); foreign != 0)
    findings_.add("axis_unknown", motion.location.line, fmt::format("the machine has no axis {}", letter_of(foreign)));
  const auto known = static_cast<std::uint8_t>(motion.known & axes_);
  const auto missing = static_cast<std::uint8_t>(axes_ & ~known);
  const bool only_says_where = (motion.moved & known) == 0 && motion.move == NcMove::rapid;
  if (missing != 0 && !only_says_where)
    findings_.add("unknown_position", motion.location.line,
                  fmt::format("the tool moves before the program gives a position of {}", letter_of(missing)));
}

}  // namespace retrace::fabrication
