#include "studies/metrology/metrology.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "core/error.h"
#include "core/number_format.h"
#include "requests/descriptions.h"
#include "surface_models/autocorrelation.h"
#include "surface_models/form.h"

namespace retrace::studies {
namespace {

using namespace surface_models;

/// Maximum number of rows of a map to which an edge is fitted. Of more rows, evenly spaced ones are selected. The fit
/// of one row takes some milliseconds.
constexpr std::size_t kMaxEdgeProfiles = 256;
/// Minimum number of points per cut-off length. With fewer points, the filter is not sampled.
constexpr double kMinPointsPerCutoff = 2.0;
constexpr double kMaxMissingFraction = 0.05;
constexpr double kMinPointsPerLength = 2.0;
/// Width of the strip on each side of a scratch with which the scratch is compared, in cut-off lengths.
constexpr double kBesideScratch = 0.25;

/// Checks that the cut-off wavelength is at least twice the point spacing of a height map.
/// \param name name of the map, for error messages
void check_spacing(const std::string& name, double cutoff_um, const HeightMap& map) {
  const double coarser = map.is_profile() ? map.x_pixel_um : std::max(map.x_pixel_um, map.y_pixel_um);
  if (cutoff_um < kMinPointsPerCutoff * coarser)
    throw InputError(
        {name, 0, reference({"cutoff_um"})},
        fmt::format("must be at least twice the spacing of {} um, got {}", shortest(coarser), shortest(cutoff_um)));
}

/// Returns the degree of the polynomial that is fitted as the form: 0 for "none", 1 for "plane", k for "poly<k>".
/// \pre `form` is "none", "plane" or "poly<k>"
int degree_of(const std::string& form) {
  return form == "none" ? 0 : form == "plane" ? 1 : form.back() - '0';
}
static_assert(kMaxFormDegree < 10, "the degree of a form is one digit");

/// Returns every n-th row of a map, with the smallest n for which at most kMaxEdgeProfiles rows remain.
HeightMap thinned(const HeightMap& map) {
  const std::size_t stride = (map.rows + kMaxEdgeProfiles - 1) / kMaxEdgeProfiles;
  HeightMap thin{map.columns, 0, map.x_pixel_um, map.y_pixel_um * static_cast<double>(stride), {}};
  for (std::size_t row = 0; row < map.rows; row += stride, ++thin.rows)
    for (std::size_t column = 0; column < map.columns; ++column) thin.heights_nm.push_back(map.at(column, row));
  return thin;
}

/// Fits an edge to every row, and stores the heights minus the fitted edge in the result.
void measure_edge(MetrologyResult& result, const HeightMap& whole) {
  const HeightMap map = thinned(whole);
  if (map.rows < whole.rows)
    result.warnings.push_back(
        {"rows_subsampled", fmt::format("the edge is fitted to {} of {} rows at equal spacing", map.rows, whole.rows)});
  std::vector<double> radius, chamfer, dihedral, radius_residual, chamfer_residual;
  std::string refusal;
  result.surface = map;
  for (std::size_t row = 0; row < map.rows; ++row) {
    const auto begin = map.heights_nm.begin() + static_cast<std::ptrdiff_t>(row * map.columns);
    const auto out = result.surface.heights_nm.begin() + static_cast<std::ptrdiff_t>(row * map.columns);
    try {
      const EdgeFit fit = fit_edge({begin, begin + static_cast<std::ptrdiff_t>(map.columns)}, map.x_pixel_um);
      radius.push_back(fit.radius_um);
      chamfer.push_back(fit.chamfer_um);
      dihedral.push_back(fit.dihedral_deg);
      radius_residual.push_back(fit.radius_residual_nm);
      chamfer_residual.push_back(fit.chamfer_residual_nm);
      std::copy(fit.residual_nm.begin(), fit.residual_nm.end(), out);
    } catch (const std::invalid_argument& error) {
      refusal = error.what();
      std::fill_n(out, map.columns, kMissing);
    }
  }
  if (radius.empty()) throw InputError({result.file, 0, reference({"edge"})}, refusal);
  if (radius.size() < map.rows)
    result.warnings.push_back({"rows_without_edge", fmt::format("{} of {} rows show no edge and are left out",
                                                                map.rows - radius.size(), map.rows)});
  EdgeResult edge{summarise(radius),
                  summarise(chamfer),
                  summarise(dihedral),
                  summarise(radius_residual).median,
                  summarise(chamfer_residual).median,
                  EdgeShape::radius};
  if (edge.chamfer_residual_nm < edge.radius_residual_nm) edge.better = EdgeShape::chamfer;
  result.edge = edge;
}

void warn(MetrologyResult& result, const HeightMap& map) {
  const double missing = static_cast<double>(result.missing) / static_cast<double>(map.heights_nm.size());
  if (missing > kMaxMissingFraction)
    result.warnings.push_back(
        {"missing_points", fmt::format("{} % of the points are missing", fixed(100.0 * missing, 1))});
  const double x_um = static_cast<double>(map.columns) * map.x_pixel_um;
  const double y_um = map.is_profile() ? x_um : static_cast<double>(map.rows) * map.y_pixel_um;
  if (result.request.cutoff_um > 0.5 * std::min(x_um, y_um))
    result.warnings.push_back(
        {"cutoff_too_long", fmt::format("the cut-off of {} um is longer than half of the map's shorter side of {} um",
                                        shortest(result.request.cutoff_um), shortest(std::min(x_um, y_um)))});
  if (result.edge) return;  // the heights minus the edge do not describe the texture of a facet
  const auto& length = result.texture.correlation_length_um;
  if (!length && result.of_roughness.sq_nm > 0.0)
    result.warnings.push_back({"no_correlation_length",
                               "the correlation length cannot be determined, because the autocorrelation of the "
                               "roughness does not fall to 1/e within the cut-off"});
  if (length && *length < kMinPointsPerLength * map.x_pixel_um)
    result.warnings.push_back(
        {"correlation_length_unresolved",
         fmt::format("the correlation length of {} um is not resolved by the point spacing of {} um", fixed(*length, 3),
                     shortest(map.x_pixel_um))});
}

}  // namespace

HeightMapOptions reading_of(const MetrologyRequest& request) {
  HeightMapOptions reading;
  reading.x_pixel_um = request.x_pixel_um;
  reading.y_pixel_um = request.y_pixel_um ? request.y_pixel_um : request.x_pixel_um;
  reading.height_unit = request.height_unit;
  reading.lateral_unit = request.lateral_unit;
  reading.channel = request.channel;
  return reading;
}

double frequency_hz(double frequency_per_mm, double feed_mm_per_min) {
  return frequency_per_mm * feed_mm_per_min / 60.0;
}

MetrologyResult measure_surface(const std::string& file, const MetrologyRequest& request) {
  requests::check(request);
  return measure_surface(file, request, read_height_map(file, reading_of(request)));
}

MetrologyResult measure_surface(const std::string& name, const MetrologyRequest& request, HeightMapFile file) {
  requests::check(request);
  check_spacing(name, request.cutoff_um, file.map);
  MetrologyResult result;
  result.file = name;
  result.request = request;
  result.format = std::move(file.format);
  result.warnings = std::move(file.warnings);
  result.missing = file.map.heights_nm.size() - measured_points(file.map);
  const int degree = degree_of(request.form);
  if (request.edge)
    measure_edge(result, file.map);
  else
    result.surface = degree == 0 ? file.map : without_form(file.map, degree);

  const HeightMap& surface = result.surface;
  result.split = gaussian_split(surface, request.cutoff_um);
  result.of_surface = height_parameters(surface.heights_nm);
  result.of_roughness = height_parameters(result.split.roughness.heights_nm);
  result.of_waviness = height_parameters(result.split.waviness.heights_nm);
  result.along_x = line_spectrum(surface, Axis::x);
  result.radial = radial_spectrum(surface);
  if (!surface.is_profile()) result.along_y = line_spectrum(surface, Axis::y);
  result.peaks = dominant_peaks(surface);
  const Autocorrelation r = autocorrelation(result.split.roughness, request.cutoff_um);
  result.x_correlation_length_um = correlation_length_um(r, Axis::x);
  if (!surface.is_profile()) result.y_correlation_length_um = correlation_length_um(r, Axis::y);
  result.texture = texture_model(result.split, request.cutoff_um);
  for (const Axis along : {Axis::x, Axis::y})
    for (const Scratch& scratch : find_scratches(result.split.roughness, along, kBesideScratch * request.cutoff_um))
      result.scratches.push_back(scratch);
  warn(result, surface);
  return result;
}

}  // namespace retrace::studies
