#include "studies/design/scratch_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <variant>

#include "core/io/toml_node.h"
#include "core/number_format.h"

namespace retrace::studies {
namespace {

using geometry::PartSpec;
using geometry::RtpElement;
using geometry::Scratch;

constexpr std::string_view kScratches = "scratches";
constexpr std::size_t kMostScratches = 200;
constexpr Range kWidthUm{.low = 0.01, .high = 100.0};
constexpr std::array kFacets = {Choice<std::size_t>{"-x", 0}, Choice<std::size_t>{"+x", 1}};

Scratch read_scratch(TableReader& table, const RtpElement& element) {
  Scratch scratch;
  scratch.facet = table.required_choice("facet", std::span<const Choice<std::size_t>>(kFacets));
  const double width_um = table.required_number("width_um", kWidthUm);
  const double reach_um = 0.5 * (1e3 * element.width_mm - width_um);
  if (reach_um <= 0.0)
    table.fail("width_um", fmt::format("must be < {}, the element's width, got {}", shortest(1e3 * element.width_mm),
                                       shortest(width_um)));
  scratch.width_mm = 1e-3 * width_um;
  scratch.position_mm = 1e-3 * table.required_number("position_um", {.low = -reach_um, .high = reach_um});
  scratch.depth_mm = 1e-3 * table.required_number("depth_um", {.low = -0.5 * width_um, .high = 0.5 * width_um});
  table.finish();
  return scratch;
}

bool overlap(const Scratch& a, const Scratch& b) {
  const double apart_mm = std::abs(a.position_mm - b.position_mm);
  return a.facet == b.facet && apart_mm < 0.5 * (a.width_mm + b.width_mm) * (1.0 - 1e-9);
}

}  // namespace

void read_scratches(const DesignDocument& document, TableReader& surface, PartSpec& part) {
  const toml::node* const node = surface.node(kScratches);
  if (node == nullptr) return;
  const toml::array* const list = node->as_array();
  if (list == nullptr || !list->is_homogeneous<toml::table>())
    surface.fail(kScratches,
                 "must be a list of tables with facet, position_um, width_um and depth_um, got " + shown(*node));
  const auto* const element = std::get_if<RtpElement>(&part.element);
  if (element == nullptr) surface.fail(kScratches, "only allowed for kind = \"rtp\"");
  if (part.base) surface.fail(kScratches, "not allowed with [base]");
  if (list->size() > kMostScratches)
    surface.fail(kScratches, fmt::format("must be at most {}, got {}", kMostScratches, list->size()));
  for (const toml::node& entry : *list) {
    const std::string name = fmt::format("surface.scratches[{}]", part.scratches.size() + 1);
    TableReader table(document, name, *entry.as_table());
    const Scratch scratch = read_scratch(table, *element);
    if (std::any_of(part.scratches.begin(), part.scratches.end(),
                    [&](const Scratch& s) { return overlap(s, scratch); }))
      table.fail("position_um", fmt::format("must keep clear of the other scratches of its facet, got {}",
                                            shortest(1e3 * scratch.position_mm)));
    part.scratches.push_back(scratch);
  }
}

}  // namespace retrace::studies
