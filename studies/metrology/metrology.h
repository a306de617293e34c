#pragma once

// Evaluates measured height maps: roughness, waviness and edge radii, as quantities that designs use to describe
// surfaces. `retrace metrology` runs this study.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/warning.h"
#include "requests/metrology.h"
#include "surface_models/edge_fit.h"
#include "surface_models/gaussian_filter.h"
#include "surface_models/height_map.h"
#include "surface_models/height_parameters.h"
#include "surface_models/io/height_map_reader.h"
#include "surface_models/scratches.h"
#include "surface_models/spectrum.h"
#include "surface_models/texture_model.h"

namespace retrace::studies {

/// Edge that is fitted to each profile (row) of a map. Summaries and medians are over all profiles.
struct EdgeResult {
  surface_models::Summary radius_um;
  surface_models::Summary chamfer_um;
  surface_models::Summary dihedral_deg;
  /// Median of the residual of the fit with a radius.
  double radius_residual_nm = 0.0;
  /// Median of the residual of the fit with a chamfer.
  double chamfer_residual_nm = 0.0;
  surface_models::EdgeShape better = surface_models::EdgeShape::radius;  ///< shape with the lower median residual
};

/// Result of the evaluation of a height map.
struct MetrologyResult {
  std::string file;  ///< file name of the height map
  MetrologyRequest request;
  std::string format;
  std::size_t missing = 0;            ///< number of points without a height
  surface_models::HeightMap surface;  ///< heights after removal of the form or of the edge
  surface_models::Split split;
  surface_models::HeightParameters of_surface;
  surface_models::HeightParameters of_roughness;
  surface_models::HeightParameters of_waviness;
  surface_models::Spectrum along_x;
  surface_models::Spectrum along_y;
  surface_models::Spectrum radial;
  std::vector<surface_models::SpectralPeak> peaks;  ///< peaks of the spectrum, the strongest first
  std::optional<double> x_correlation_length_um;    ///< correlation length along x of the filtered roughness
  std::optional<double> y_correlation_length_um;
  surface_models::TextureModel texture;
  std::vector<surface_models::Scratch> scratches;
  std::optional<EdgeResult> edge;
  Warnings warnings;
};

/// Returns the options with which the height map of a request is read.
surface_models::HeightMapOptions reading_of(const MetrologyRequest& request);

/// Returns the frequency, in Hz, with which waves pass the tool at a feed.
double frequency_hz(double frequency_per_mm, double feed_mm_per_min);

/// Measures a surface that has already been read.
/// \param name name of the surface, for messages
/// \param request settings of the evaluation. Options for reading a file are checked but have no other effect.
/// \throw InputError for an invalid request
MetrologyResult measure_surface(const std::string& name, const MetrologyRequest& request,
                                surface_models::HeightMapFile file);

/// Reads a height map and measures its surface.
/// \throw InputError for an invalid file or request
MetrologyResult measure_surface(const std::string& file, const MetrologyRequest& request);

}  // namespace retrace::studies
