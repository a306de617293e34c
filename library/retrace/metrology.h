#pragma once

// Roughness, waviness and edges of measured surfaces.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/warning.h"
#include "retrace/drawing.h"

namespace retrace {

/// As the options of `retrace metrology`.
struct MetrologyRequest {
  std::string form = "plane";             ///< that is removed: none, plane or poly2 to poly8
  double cutoff_um = 80.0;                ///< of the Gaussian filter between roughness and waviness
  std::optional<double> x_pixel_um = {};  ///< spacing of the points along x; by default what the file says
  std::optional<double> y_pixel_um = {};
  std::optional<std::string> height_unit = {};   ///< of a file: m, mm, um, nm or pm
  std::optional<std::string> lateral_unit = {};  ///< likewise
  std::optional<std::size_t> channel = {};       ///< of a GWY file; by default the first
  std::optional<double> feed_mm_per_min = {};    ///< of the cut, for waves in Hz
  bool edge = false;                             ///< rows are profiles across an edge
};

/// Heights on a grid.
struct HeightMap {
  std::size_t columns = 0;         ///< along x
  std::size_t rows = 0;            ///< along y; 1: a profile
  std::vector<double> heights_nm;  ///< row by row, positive out of the material; NaN where nothing was measured
};

struct Metrology {
  Warnings warnings;
  std::string json;          ///< document retrace.metrology/1
  std::string table;         ///< for people
  std::string surface_toml;  ///< table [surface] of a design file that describes this surface
  std::string spectra_csv;   ///< power spectral densities: direction,frequency_per_mm,psd,unit
  Drawing drawing;
  double x_pixel_um = 0.0;
  double y_pixel_um = 0.0;
  HeightMap surface;  ///< less its form
  HeightMap roughness;
  HeightMap waviness;
};

/// Of a file: text, SDF, GSF or GWY. \throw InputError
RETRACE_API Metrology metrology(const std::filesystem::path& file, const MetrologyRequest& request = {});
/// Of heights in memory. \param request with the spacing of points, along x at least \throw InputError
RETRACE_API Metrology metrology(const HeightMap& heights, const MetrologyRequest& request);

}  // namespace retrace
