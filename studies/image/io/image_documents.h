#pragma once

// Output documents and tables of `retrace image`.

#include <string>
#include <vector>

#include "studies/image/camera_study.h"
#include "studies/image/detector_study.h"
#include "studies/image/road_study.h"

namespace retrace::studies {

/// The following functions return documents of the format `retrace.image/1` for each kind of picture, without the
/// pixels.
std::string detector_json(const DetectorResult& result);
std::string camera_json(const CameraResult& result);
/// Returns the document of several camera pictures.
/// \param warnings warnings of all pictures
/// \param complete true if all requested pictures are complete
std::string camera_series_json(const std::vector<CameraResult>& results, const Warnings& warnings, bool complete);
std::string road_json(const RoadResult& result);

/// The following functions return tables for the terminal.
std::string detector_table(const DetectorResult& result);
std::string camera_table(const CameraResult& result);
std::string camera_series_table(const std::vector<CameraResult>& results);
std::string road_table(const RoadResult& result);

}  // namespace retrace::studies
