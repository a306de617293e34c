#pragma once

// Computes pictures of a detector, of a camera, and of a driver's view at night.

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "core/warning.h"
#include "requests/image.h"
#include "retrace/design.h"
#include "retrace/drawing.h"
#include "retrace/running.h"

namespace retrace {

/// A picture as numbers, with its drawing.
struct Picture {
  std::string name;  ///< name of the file that --out writes, without extension, such as "irradiance"
  std::size_t columns = 0;
  std::size_t rows = 0;
  /// Names of the channels and their values, one for each pixel, row by row from the top.
  std::vector<std::pair<std::string, std::vector<double>>> channels;
  Drawing drawing;
};

struct ImageResult {
  std::vector<Picture> pictures;
  Drawing sheet;  ///< drawing of all pictures of a series next to each other; empty for one picture
  Warnings warnings;
  bool complete = true;
  std::string json;   ///< JSON document retrace.image/1
  std::string table;  ///< summary as text
};

/// Computes maps of the returned light over the entrance face and over the directions.
/// \throw InputError
/// \throw BudgetError if the ray tracer lost power
RETRACE_API ImageResult detector(const Design& design, const DetectorRequest& request = {},
                                 const Running& running = {});
/// Computes a camera picture of the part. Throws like detector().
RETRACE_API ImageResult camera(const Design& design, const CameraRequest& request = {}, const Running& running = {});
/// Computes several camera pictures, which are displayed with the same exposure: one for each design, or one for each
/// request. Their names are "camera_01", "camera_02" and so on. The JSON document has the kind `camera_series`. If the
/// computation is cancelled, the result has only the pictures that were computed.
/// \param designs one design, or one for each picture; at most 64
/// \param requests one request, or one for each picture; at most 64
/// \throw InputError if both lists have several elements, if one of them is empty, or in the same cases as camera()
/// \throw BudgetError if the ray tracer lost power
RETRACE_API ImageResult camera_series(const std::vector<Design>& designs,
                                      const std::vector<CameraRequest>& requests = {CameraRequest()},
                                      const Running& running = {});
/// Computes a driver's views at night of reflectors on a car ahead or of a sign. Throws like detector().
RETRACE_API ImageResult road(const Design& design, const RoadRequest& request = {}, const Running& running = {});

}  // namespace retrace
