#pragma once

// Computes roughness, waviness and edges of measured surfaces.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/warning.h"
#include "retrace/drawing.h"

namespace retrace {

/// Settings of the analysis. They correspond to the options of `retrace metrology`.
struct MetrologyRequest {
  std::string form = "plane";  ///< form that is removed: none, plane or poly2 to poly8
  double cutoff_um = 80.0;     ///< cut-off of the Gaussian filter between roughness and waviness
  /// Spacing of the points along x; by default, the spacing that the file contains.
  std::optional<double> x_pixel_um = {};
  std::optional<double> y_pixel_um = {};
  std::optional<std::string> height_unit = {};   ///< unit of the heights in a file: m, mm, um, nm or pm
  std::optional<std::string> lateral_unit = {};  ///< unit of lengths in a file: m, mm, um, nm or pm
  std::optional<std::size_t> channel = {};       ///< channel of a GWY file; by default, the first
  /// Feed of the cut; if given, frequencies of waves are also given in Hz.
  std::optional<double> feed_mm_per_min = {};
  bool edge = false;  ///< true: the rows are profiles across an edge
};

/// Heights on a grid.
struct HeightMap {
  std::size_t columns = 0;         ///< number of points along x
  std::size_t rows = 0;            ///< number of points along y; 1 for a profile
  std::vector<double> heights_nm;  ///< row by row, positive out of the material; NaN where nothing was measured
};

struct Metrology {
  Warnings warnings;
  std::string json;          ///< JSON document retrace.metrology/1
  std::string table;         ///< summary as text
  std::string surface_toml;  ///< table [surface] of a design file that describes this surface
  std::string spectra_csv;   ///< power spectral densities: direction,frequency_per_mm,psd,unit
  Drawing drawing;
  double x_pixel_um = 0.0;
  double y_pixel_um = 0.0;
  HeightMap surface;  ///< heights after the form was removed
  HeightMap roughness;
  HeightMap waviness;
};

/// Analyses a measured surface in a file (text, SDF, GSF or GWY).
/// \throw InputError
RETRACE_API Metrology metrology(const std::filesystem::path& file, const MetrologyRequest& request = {});
/// Analyses heights in memory.
/// \param request settings, which must contain at least the spacing of the points along x
/// \throw InputError
RETRACE_API Metrology metrology(const HeightMap& heights, const MetrologyRequest& request);

}  // namespace retrace
