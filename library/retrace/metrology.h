#pragma once

// Computes roughness, waviness and edges of measured surfaces.

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "core/warning.h"
#include "requests/metrology.h"
#include "retrace/drawing.h"

namespace retrace {

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
