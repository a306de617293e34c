#include "studies/design/ball_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/angle.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "studies/design/table_reader.h"

namespace retrace::studies {
namespace {

constexpr Range kBallSize{.low = 1e-6, .high = 1e6};
constexpr Range kBallGap{.low = 0.0, .high = 1e6};
constexpr Range kMirrorAngle{.low = 0.0, .low_included = false, .high = 90.0};

/// Endless and hexagonal, or a single ball.
bool read_is_layer(TableReader& array) {
  constexpr std::array kArrangements = {Choice<bool>{"packed", true}, Choice<bool>{"single", false}};
  constexpr std::array kExtents = {Choice<bool>{"infinite", true}, Choice<bool>{"finite", false}};
  const bool is_layer = array.choice("arrangement", std::span<const Choice<bool>>(kArrangements)).value_or(true);
  const bool is_infinite = array.choice("extent", std::span<const Choice<bool>>(kExtents)).value_or(is_layer);
  if (is_infinite != is_layer)
    array.fail("extent", is_layer ? "must be \"infinite\" for arrangement = \"packed\", got \"finite\""
                                  : "must be \"finite\" for arrangement = \"single\", got \"infinite\"");
  return is_layer;
}

void refuse_other_keys(TableReader& element, TableReader& array) {
  element.refuse({"base_mm", "width_mm", "apex_angle_deg", "aperture_mm", "cant_deg", "cant_azimuth_deg"},
                 "not allowed for kind = \"ball\", which has diameter_mm");
  array.refuse({"shifted_rows", "partial_elements", "x_length_mm", "y_length_mm", "x_gap_mm", "y_gap_mm", "x_offset_mm",
                "y_offset_mm", "overlap_percent", "mask", "mask_threshold"},
               "not allowed for kind = \"ball\", whose layers are endless, with gap_mm between the balls");
}

/// How far the mirror reaches: what a neighbour's bowl leaves of it, unless less is asked for.
void read_mirror(TableReader& element, raytrace::BallLayer& balls) {
  balls.mirror_offset_mm = element.number("mirror_offset_mm", kBallGap).value_or(0.0);
  double most_deg = 90.0;
  if (balls.pitch_mm && balls.mirror_offset_mm > 0.0)
    most_deg = Angle::from_rad(std::asin(std::min(1.0, 0.5 * *balls.pitch_mm / balls.mirror_radius_mm()))).deg();
  const auto given_deg = element.number("mirror_half_angle_deg", kMirrorAngle);
  if (given_deg && *given_deg > most_deg + 1e-9)
    element.fail("mirror_half_angle_deg", fmt::format("must be <= {} where the bowls of neighbours meet, got {}",
                                                      fixed(most_deg, 6), shortest(*given_deg)));
  balls.mirror_half_angle_deg = std::min(given_deg.value_or(most_deg), most_deg);
}

}  // namespace

bool has_balls(const DesignDocument& document) {
  TableReader element(document, "element");
  return element.is_text("kind") && element.text("kind") == "ball";
}

raytrace::BallLayer read_balls(const DesignDocument& document) {
  TableReader element(document, "element");
  TableReader array(document, "array");
  element.skip({"kind"});
  refuse_other_keys(element, array);
  raytrace::BallLayer balls;
  element.required_number("diameter_mm", kPositive);
  balls.diameter_mm = element.required_number("diameter_mm", kBallSize);
  const double gap_mm = array.number("gap_mm", kBallGap).value_or(0.0);
  if (read_is_layer(array))
    balls.pitch_mm = balls.diameter_mm + gap_mm;
  else if (array.has("gap_mm"))
    array.fail("gap_mm", "not allowed for arrangement = \"single\"");
  read_mirror(element, balls);
  element.finish();
  array.finish();
  if (const toml::node* const node = document.root().get("surface"))
    if (!node->is_table() || !node->as_table()->empty())
      throw InputError(document.location(*node, "surface"),
                       "not allowed for kind = \"ball\", whose surfaces are smooth");
  if (const toml::node* const node = document.root().get("part"))
    throw InputError(document.location(*node, "part"), "not allowed for kind = \"ball\"");
  return balls;
}

}  // namespace retrace::studies
