#pragma once

// The plots of results: what is drawn of them, not how.

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "core/pictures.h"
#include "report/image_plot.h"
#include "report/map_plot.h"
#include "report/mixture_plot.h"
#include "report/path_plot.h"
#include "report/plot.h"
#include "report/polar_plot.h"
#include "report/surface_plot.h"

namespace retrace::studies {

struct CameraResult;
struct ComposeRequest;
struct Composition;
struct Design;
struct DetectorResult;
struct ErrorMap;
struct FabricationResult;
struct ForcesResult;
struct MetrologyResult;
struct PhotometryResult;
struct PlaningResult;
struct RoadResult;
struct RoughnessResult;
struct RreResult;
struct Study;
struct ToleranceRequest;
struct ToleranceResult;
struct TurningResult;

}  // namespace retrace::studies

namespace retrace::report {

/// RRE in percent against the incidence angle, one curve a design, azimuth and acceptance cone. With a single incidence
/// angle the axis is the azimuth, with a single direction the acceptance half angle.
LinePlot rre_plot(const studies::RreResult& result);

/// More directions than this are not drawn.
inline constexpr std::size_t kMostFootprintPanels = 24;

/// The active regions of the entrance face, one panel a direction, coloured by their efficiency in percent.
/// \pre a footprint was requested
MapPlot footprint_plot(const studies::RreResult& result);

/// RRE over the Sa of the roughness: a curve for each correlation length, and measured facets as points.
LinePlot roughness_plot(const studies::RoughnessResult& result);

/// R_A around the return for every map of a result, with the test points on it.
PolarPlot far_field_plot(const studies::PhotometryResult& result);

/// R_A over the observation angle, one curve for each entrance angle.
LinePlot observation_plot(const studies::PhotometryResult& result);

/// The share of parts below a value of the study's first quantity, with its nominal value and the limits on it.
LinePlot tolerance_plot(const studies::Study& study, const studies::ToleranceRequest& request,
                        const studies::ToleranceResult& result);

/// The zones of a part beside what each gives to each goal. Without zones if there is no part.
MixturePlot composition_plot(const studies::Study& study, const studies::ComposeRequest& request,
                             const studies::Composition& composition);

/// A measured surface less its form, its roughness, its waviness and its power spectral densities.
SurfacePlot metrology_plot(const studies::MetrologyResult& result);

// Of a detector and a camera.

/// What a picture's file says of itself. \param kind that of its document
std::vector<std::pair<std::string, std::string>> picture_texts(const char* kind, const studies::Design& design);
/// What leaves, and where it entered.
ImagePlot irradiance_plot(const studies::DetectorResult& result);
/// Around the direction back to the source, colours by decades.
ImagePlot angular_plot(const studies::DetectorResult& result);
/// Channels `leaving` and `entering`, with their standard errors where there are any.
FloatPicture irradiance_picture(const studies::DetectorResult& result);
FloatPicture angular_picture(const studies::DetectorResult& result);
/// Channels Y (cd/m^2), `std_error` and `coverage`.
FloatPicture luminance_picture(const studies::CameraResult& result);
/// The picture as the eye might see it, three bytes a pixel.
std::vector<unsigned char> tone_mapped_pixels(const std::vector<double>& luminance);
/// Luminance as colours by decades.
ImagePlot false_colour_plot(const studies::CameraResult& result);

/// The views side by side as the driver sees them, all exposed alike, with distances and luminances. A PNG file.
/// \throw OutputError if it cannot be drawn
std::string road_png(const studies::RoadResult& result, double scale = 1.5);

/// The luminances of all views one beside the other, channel Y, and `reflected`: what of it the reflectors send.
FloatPicture road_picture(const studies::RoadResult& result);

/// The way of the tool through one element, roughing or finishing.
PathPlot tool_path_plot(const studies::FabricationResult& result, bool roughing);

/// Which elements are cut where, coloured by the order in which they are visited. Of large arrays neighbours in a row
/// are drawn as one.
MapPlot arrangement_plot(const studies::FabricationResult& result);

/// The array from above, coloured by what programs leave over its facets.
SurfacePlot error_map_plot(const studies::ErrorMap& map);

/// Forces on the tool against time, one curve an axis of the machine.
LinePlot forces_plot(const studies::ForcesResult& result);

/// Acceleration of Z over two turns round its largest jump.
LinePlot turning_acceleration_plot(const studies::TurningResult& result);
/// Deviation from the design across a few cuts.
LinePlot turning_profile_plot(const studies::TurningResult& result);
/// The surface's height, and the size of what the programs leave on it.
ImagePlot turning_maps(const studies::TurningResult& result);

/// Depth over the distance from the middle: the design, and what the programs leave (of a lathe: its chords).
LinePlot planing_profile_plot(const studies::PlaningResult& result);
/// Where the strokes of a mill go, by set of programs; of a lathe: the ends of its chords.
LinePlot planing_zones_plot(const studies::PlaningResult& result);
/// What is left above the design over the distance from the middle; mill only.
LinePlot planing_error_plot(const studies::PlaningResult& result);

}  // namespace retrace::report
