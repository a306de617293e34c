#pragma once

// Measured height maps: roughness, waviness and edge radii in the terms that designs take. The study behind `retrace
// metrology`.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/warning.h"
#include "surface_models/edge_fit.h"
#include "surface_models/gaussian_filter.h"
#include "surface_models/height_map.h"
#include "surface_models/height_parameters.h"
#include "surface_models/io/height_map_reader.h"
#include "surface_models/scratches.h"
#include "surface_models/spectrum.h"
#include "surface_models/texture_model.h"

namespace retrace::studies {

/// What to measure, and how.
struct MetrologyRequest {
  std::string file;
  surface_models::HeightMapOptions reading;
  int form_degree = 1;  ///< of the polynomial that is removed; 0: none
  double cutoff_um = 80.0;
  std::optional<double> feed_mm_per_min;  ///< of the cut along the waves, for their frequency in time
  bool edge = false;  ///< rows are profiles across an edge; its shape is removed in place of the form
};

/// An edge, over the profiles (rows) of a map.
struct EdgeResult {
  surface_models::Summary radius_um;
  surface_models::Summary chamfer_um;
  surface_models::Summary dihedral_deg;
  double radius_residual_nm = 0.0;                                       ///< median over the profiles
  double chamfer_residual_nm = 0.0;                                      ///< likewise
  surface_models::EdgeShape better = surface_models::EdgeShape::radius;  ///< of the lower median residual
};

/// A measured surface.
struct MetrologyResult {
  MetrologyRequest request;
  std::string format;
  std::size_t missing = 0;            ///< points without a height
  surface_models::HeightMap surface;  ///< less its form
  surface_models::Split split;
  surface_models::HeightParameters of_surface;
  surface_models::HeightParameters of_roughness;
  surface_models::HeightParameters of_waviness;
  surface_models::Spectrum along_x;
  surface_models::Spectrum along_y;
  surface_models::Spectrum radial;
  std::vector<surface_models::SpectralPeak> peaks;  ///< strongest first
  std::optional<double> x_correlation_length_um;    ///< of the roughness, as it is after the filter
  std::optional<double> y_correlation_length_um;
  surface_models::TextureModel texture;
  std::vector<surface_models::Scratch> scratches;
  std::optional<EdgeResult> edge;
  Warnings warnings;
};

/// The degree that a word names: `none`, `plane`, `poly2` to `poly8`. \throw InputError naming --form
int form_degree_of(std::string_view name);
std::string form_name(int degree);

/// The frequency in time of a wave that was cut at that feed.
double frequency_hz(double frequency_per_mm, double feed_mm_per_min);

/// Measures a surface that was read. \param request its file and reading are not looked at \throw InputError likewise
MetrologyResult measure_surface(const MetrologyRequest& request, surface_models::HeightMapFile file);

/// Reads and measures a surface. \throw InputError for a file or a request that makes no sense
MetrologyResult measure_surface(const MetrologyRequest& request);

}  // namespace retrace::studies
