#include "studies/design/scratch_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <variant>

#include "core/number_format.h"

namespace retrace::studies {
namespace {

using geometry::PartSpec;
using geometry::RtpElement;
using geometry::Scratch;

constexpr std::string_view kScratches = "surface.scratches";
constexpr std::size_t kMostScratches = 200;

bool overlap(const Scratch& a, const Scratch& b) {
  const double apart_mm = std::abs(a.position_mm - b.position_mm);
  return a.facet == b.facet && apart_mm < 0.5 * (a.width_mm + b.width_mm) * (1.0 - 1e-9);
}

Scratch read_scratch(const schema::Document& document, const std::string& entry, const RtpElement& element) {
  const std::string width = entry + ".width_um";
  const double width_um = document.number(width);
  const double reach_um = 0.5 * (1e3 * element.width_mm - width_um);
  if (reach_um <= 0.0)
    document.fail(width, fmt::format("must be < {}, the element's width, got {}", shortest(1e3 * element.width_mm),
                                     shortest(width_um)));
  const auto within = [&](const std::string& key, double reach) {
    const NumberRange range{.low = -reach, .high = reach};
    const double value = document.number(key);
    if (!range.contains(value)) document.fail(key, fmt::format("must be {}, got {}", range.text(), shortest(value)));
    return value;
  };
  Scratch scratch;
  scratch.facet = document.index(entry + ".facet");
  scratch.width_mm = 1e-3 * width_um;
  scratch.position_mm = 1e-3 * within(entry + ".position_um", reach_um);
  scratch.depth_mm = 1e-3 * within(entry + ".depth_um", 0.5 * width_um);
  return scratch;
}

}  // namespace

void read_scratches(const schema::Document& document, PartSpec& part) {
  if (!document.has(kScratches)) return;
  if (part.base) document.fail(kScratches, "not allowed with [base]");
  const std::size_t count = document.count(kScratches);
  if (count > kMostScratches)
    document.fail(kScratches, fmt::format("must be at most {}, got {}", kMostScratches, count));
  for (std::size_t i = 0; i < count; ++i) {
    const std::string entry = schema::path_of_entry(kScratches, i);
    const Scratch scratch = read_scratch(document, entry, std::get<RtpElement>(part.element));
    if (std::ranges::any_of(part.scratches, [&](const Scratch& other) { return overlap(other, scratch); }))
      document.fail(entry + ".position_um", fmt::format("must keep clear of the other scratches of its facet, got {}",
                                                        shortest(1e3 * scratch.position_mm)));
    part.scratches.push_back(scratch);
  }
}

}  // namespace retrace::studies
