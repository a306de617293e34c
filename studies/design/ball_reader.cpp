#include "studies/design/ball_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "core/number_format.h"

namespace retrace::studies {
namespace {

/// How far the mirror reaches: what a neighbour's bowl leaves of it, unless less is asked for.
void read_mirror(const schema::Document& document, raytrace::BallLayer& balls) {
  balls.mirror_offset_mm = document.number_if("element.mirror_offset_mm").value_or(0.0);
  double most_deg = 90.0;
  if (balls.pitch_mm && balls.mirror_offset_mm > 0.0)
    most_deg = Angle::from_rad(std::asin(std::min(1.0, 0.5 * *balls.pitch_mm / balls.mirror_radius_mm()))).deg();
  const auto given_deg = document.number_if("element.mirror_half_angle_deg");
  if (given_deg && *given_deg > most_deg + 1e-9)
    document.fail("element.mirror_half_angle_deg",
                  fmt::format("must be <= {} where the bowls of neighbours meet, got {}", fixed(most_deg, 6),
                              shortest(*given_deg)));
  balls.mirror_half_angle_deg = std::min(given_deg.value_or(most_deg), most_deg);
}

}  // namespace

raytrace::BallLayer read_balls(const schema::Document& document) {
  raytrace::BallLayer balls;
  balls.diameter_mm = document.number("element.diameter_mm");
  if (document.text("array.arrangement") == "packed")
    balls.pitch_mm = balls.diameter_mm + document.number("array.gap_mm");
  read_mirror(document, balls);
  return balls;
}

}  // namespace retrace::studies
