#include "studies/design/front_reader.h"

#include <fmt/format.h>

#include <array>
#include <string>

#include "studies/design/table_reader.h"

namespace retrace::studies {
namespace {

constexpr std::array kSides = {Choice<bool>{"top", false}, Choice<bool>{"bottom", true}};
constexpr Range kPlace{.low = -1e6, .high = 1e6};

}  // namespace

std::optional<FrontFile> read_front(const DesignDocument& document, const Design& design) {
  const toml::node* const node = document.root().get("front");
  if (node == nullptr) return std::nullopt;
  if (design.balls) throw InputError(document.location(*node, "front"), "not allowed for kind = \"ball\"");
  TableReader table(document, "front");
  const bool has_mesh = table.has("mesh");
  if (!has_mesh && !table.has("turned"))
    throw InputError(document.location_of_missing(node, "front.turned"),
                     "missing, must name the file of a turned part, or front.mesh an STL file");
  if (has_mesh) table.refuse({"turned"}, "not allowed beside mesh: a part has one front");
  if (!has_mesh) table.refuse({"mesh_side"}, "only allowed with mesh");
  const std::string_view key = has_mesh ? "mesh" : "turned";
  FrontFile front;
  front.is_mesh = has_mesh;
  front.file = *table.file(key);
  front.name = *table.text(key);
  front.location = table.where(key);
  front.mesh_bottom = table.choice("mesh_side", std::span<const Choice<bool>>(kSides)).value_or(false);
  if (const auto centre = table.numbers("centre_mm", kPlace)) {
    if (centre->size() != 2)
      table.fail("centre_mm", fmt::format("must be a list of two, x and y, got a list of {}", centre->size()));
    front.centre_mm = std::array{(*centre)[0], (*centre)[1]};
  }
  table.finish();
  if (!design.mesh && design.part.extent == geometry::Extent::infinite)
    table.fail(key, "not allowed for extent = \"infinite\": give lengths");
  return front;
}

}  // namespace retrace::studies
