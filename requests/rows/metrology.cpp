#include <optional>
#include <vector>

#include "core/schema/access.h"
#include "requests/descriptions.h"
#include "requests/rows/common.h"

namespace retrace::requests {
namespace {

using schema::access, schema::access_by;

constexpr NumberRange kPositive{.low = 0.0, .low_included = false};
constexpr std::string_view kForms[] = {"none", "plane", "poly2", "poly3", "poly4", "poly5", "poly6", "poly7", "poly8"};
constexpr std::string_view kLengthUnits[] = {"m", "mm", "um", "nm", "pm"};

constexpr schema::Condition kNoEdge[] = {schema::is_absent("edge")};
constexpr Need kNeedNoEdge[] = {kNoEdge};

schema::Value pixels_um(const MetrologyRequest& request) {
  std::vector<double> given;
  for (const std::optional<double>& pixel_um : {request.x_pixel_um, request.y_pixel_um})
    if (pixel_um) given.push_back(*pixel_um);
  return given.empty() ? schema::Value() : schema::Value(given);
}
void set_pixels_um(MetrologyRequest& request, const schema::Value& value) {
  request.x_pixel_um.reset();
  request.y_pixel_um.reset();
  const auto* const numbers = std::get_if<std::vector<double>>(&value);
  if (numbers == nullptr) return;
  request.x_pixel_um = numbers->front();
  request.y_pixel_um = numbers->back();
}

constexpr Row kMetrologyRows[] = {
    {"pixel_um",
     NumberOrNumbers{.range = kPositive, .max_count = 2},
     "spacing of the points, or spacings along x and y",
     access_by<pixels_um, set_pixels_um>,
     {.value = "P|PX,PY", .notation = Notation::commas, .otherwise = "as in the file"}},
    {"form",
     Word{kForms},
     "form to remove: none, plane, or a polynomial of degree 2 to 8: poly2, poly3, poly4, poly5, poly6, poly7 or poly8",
     access<&MetrologyRequest::form>,
     {.value = "FORM"},
     kNeedNoEdge},
    {"cutoff_um",
     Number{kPositive},
     "cut-off of the Gaussian filter between roughness and waviness",
     access<&MetrologyRequest::cutoff_um>,
     {.value = "L"}},
    {"height_unit",
     Word{kLengthUnits},
     "unit of the heights: m, mm, um, nm or pm",
     access<&MetrologyRequest::height_unit>,
     {.value = "UNIT", .otherwise = "as in the file"}},
    {"lateral_unit",
     Word{kLengthUnits},
     "unit of lateral lengths without a unit: m, mm, um, nm or pm",
     access<&MetrologyRequest::lateral_unit>,
     {.value = "UNIT", .otherwise = "as in the file"}},
    {"channel",
     Integer{{.low = 0.0, .high = 999999.0}},
     "channel of a GWY file",
     access<&MetrologyRequest::channel>,
     {.value = "N", .otherwise = "the first"}},
    {"feed_mm_per_min",
     Number{kPositive},
     "feed of the cut; if it is given, the frequencies of waves are also reported in Hz",
     access<&MetrologyRequest::feed_mm_per_min>,
     {.value = "F", .otherwise = "no frequencies"}},
    {"edge", schema::Flag{}, "rows are profiles across an edge: fit its radius and chamfer",
     access<&MetrologyRequest::edge>}};

/// Rows of the fields that control the reading of a height map: pixel_um, height_unit, lateral_unit and channel.
constexpr Row kReadingRows[] = {kMetrologyRows[0], kMetrologyRows[3], kMetrologyRows[4], kMetrologyRows[5]};

}  // namespace

template <>
const Request& description<MetrologyRequest>() {
  static constexpr Request request{"metrology", "metrology", kMetrologyRows, initial_object<MetrologyRequest>};
  return request;
}

const Request& height_map_reading() {
  static constexpr Request request{"correct", "correct", kReadingRows, initial_object<MetrologyRequest>};
  return request;
}

}  // namespace retrace::requests
