#pragma once

// Converts results to the content of plots. Other headers of report/, such as report/plot.h, draw this content.

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/pictures.h"
#include "report/colour_scale.h"
#include "report/contour_plot.h"
#include "report/image_plot.h"
#include "report/map_plot.h"
#include "report/mixture_plot.h"
#include "report/path_plot.h"
#include "report/plot.h"
#include "report/plot_contents.h"
#include "report/polar_plot.h"
#include "report/surface_plot.h"

namespace retrace::design {

struct Design;

}  // namespace retrace::design

namespace retrace::studies {

struct CameraResult;
struct ComposeRequest;
struct Composition;
struct DetectorResult;
struct ErrorMap;
struct FabricationResult;
struct ForcesResult;
struct MetrologyResult;
struct OptimiseRequest;
struct Optimum;
struct PhotometryResult;
struct PlaningResult;
struct RangingResult;
struct RoadResult;
struct RoughnessResult;
struct RreResult;
struct Study;
struct ToleranceRequest;
struct ToleranceResult;
struct TurningResult;

}  // namespace retrace::studies

namespace retrace::report {

/// Returns a plot of RRE, see rre_plot() in report/plot_contents.h.
LinePlot rre_plot(const studies::RreResult& result);

/// Maximum number of panels in the drawing of polar maps.
inline constexpr std::size_t kMaxMapPanels = 12;

/// Returns polar maps of RRE in percent over incidence and azimuth, with contour lines: one panel for each design and
/// acceptance cone.
/// \pre result.has_complete_maps()
PolarPlot rre_map_plot(const studies::RreResult& result);

/// Returns polar maps of the difference of RRE between two designs, in percentage points: that of the second design
/// minus that of the first, with one panel for each acceptance cone.
/// \pre rre_maps_can_be_compared(result)
PolarPlot rre_map_difference_plot(const studies::RreResult& result);

/// Returns true if a result has maps of exactly two designs with the same acceptance cones.
bool rre_maps_can_be_compared(const studies::RreResult& result);

/// Maximum number of directions in the drawing of footprints.
inline constexpr std::size_t kMaxFootprintPanels = 24;

/// Returns a plot of the active regions of the entrance face (regions that return light). It has one panel for each
/// direction of light. The colour shows the efficiency in percent.
/// \pre a footprint was requested
MapPlot footprint_plot(const studies::RreResult& result);

/// Returns a plot of RRE against the Sa of the roughness, see roughness_plot() in report/plot_contents.h.
LinePlot roughness_plot(const studies::RoughnessResult& result);

/// Returns a plot of R_A as a function of direction, for directions around the direction to the source. It shows the
/// test points and has one panel for each map of the result.
PolarPlot far_field_plot(const studies::PhotometryResult& result);

/// Returns maps of R_A, or of R_I if the standard limits R_I, over entrance and observation angle, with contour lines.
/// There is one panel for each design, rotation and presentation angle, up to kMaxMapPanels. The test points of the
/// standard with the rotation and presentation angle of a panel are marked in it.
/// \pre the result has coefficient maps
ContourPlot coefficient_map_plot(const studies::PhotometryResult& result);

/// Returns maps of the ratio of the compared design to the design of the study, with one panel for each rotation and
/// presentation angle, up to kMaxMapPanels.
/// \pre the result has coefficient maps of two designs
ContourPlot coefficient_ratio_plot(const studies::PhotometryResult& result);

/// Returns a plot of R_A against the observation angle, with one curve for each entrance angle.
LinePlot observation_plot(const studies::PhotometryResult& result);

/// Returns a plot of the cumulative distribution of the study's first quantity: the fraction of parts whose value is
/// below the value on the x axis. The nominal value and the limits are marked.
LinePlot tolerance_plot(const studies::Study& study, const studies::ToleranceRequest& request,
                        const studies::ToleranceResult& result);

/// Returns a plot of the objective and its error for all evaluated designs. The x axis is the most important parameter.
/// The feasible range is shaded, and the best design is marked. With several continuous parameters, both axes are
/// parameters, and colours show the objective.
LinePlot optimum_plot(const studies::Study& study, const studies::OptimiseRequest& request,
                      const studies::Optimum& optimum);

/// Returns a plot of all constrained quantities, each divided by its limit. The x axis is the parameter of
/// optimum_plot(). A line at 1 shows the limits.
/// \pre the request has a constraint
LinePlot constraints_plot(const studies::Study& study, const studies::OptimiseRequest& request,
                          const studies::Optimum& optimum);

/// Returns a plot of the zones of a part and their contributions to each goal. If the search found no part, the plot
/// has no zones.
MixturePlot composition_plot(const studies::Study& study, const studies::ComposeRequest& request,
                             const studies::Composition& composition);

/// Returns a plot with four panels: the measured surface without its form, its roughness, its waviness, and its power
/// spectral densities.
SurfacePlot metrology_plot(const studies::MetrologyResult& result);

/// Returns maps of the cross section over the far field of the first point. The first map shows all returned light. If
/// the transmitted light is polarised, the next maps show its polarisation and the orthogonal polarisation.
/// \pre the result has a map
ImagePlot ranging_map_plot(const studies::RangingResult& result);
/// Returns a plot of the mean, the minimum and the maximum of the cross section on rings around the direction to the
/// source. The x axis is the angle from this direction.
/// \pre the result has a map
LinePlot ranging_rings_plot(const studies::RangingResult& result);
/// Returns a plot of the response of an array to a pulse, for the first point.
/// \pre the first point has a response
LinePlot ranging_response_plot(const studies::RangingResult& result);

// Plots and pictures of a detector and a camera.

/// Returns the metadata of a picture file.
/// \param kind kind of the document that belongs to the picture
std::vector<std::pair<std::string, std::string>> picture_texts(const char* kind, const design::Design& design);
/// Returns a plot with two maps of the light that leaves the entrance face. One map shows where the light leaves the
/// face, and the other shows where the same light entered it.
ImagePlot irradiance_plot(const studies::DetectorResult& result);
/// Returns a plot of the light as a function of its direction, for directions around the direction to the source. The
/// colour scale is logarithmic.
ImagePlot angular_plot(const studies::DetectorResult& result);
/// Returns a picture with the channels `leaving` and `entering`, and with their standard errors if there are any.
FloatPicture irradiance_picture(const studies::DetectorResult& result);
FloatPicture angular_picture(const studies::DetectorResult& result);
/// Returns a picture with the channels Y (cd/m^2), `std_error` and `coverage`.
FloatPicture luminance_picture(const studies::CameraResult& result);
/// Returns the curve by which pictures of the same series are displayed. It follows from the request of the first
/// result and, without an exposure, from the luminances of all results.
/// \pre there is at least one result
ToneCurve camera_tone(std::span<const studies::CameraResult> results);
/// Returns a PNG file with the picture as it is displayed, and a caption with the geometry and the exposure. With
/// Tone::linear and Tone::log, a bar below the picture shows the displayed luminances.
/// \throw OutputError if the picture cannot be drawn
std::string camera_png(const studies::CameraResult& result, const ToneCurve& tone);
std::string camera_png(const studies::CameraResult& result);
/// Returns a PNG file with several pictures, displayed with the same curve. Throws like camera_png().
std::string camera_sheet_png(std::span<const studies::CameraResult> results, const ToneCurve& tone);
/// Returns a plot of the luminance with a logarithmic colour scale.
ImagePlot false_colour_plot(const studies::CameraResult& result);

/// Returns a PNG file with the driver's views of the road next to each other. All views have the same exposure. Each
/// view has an inset with the enlarged reflector, and a caption with distance, angles, illuminance and luminance.
/// \pre there is at least one view
/// \throw OutputError if the picture cannot be drawn
std::string road_png(const studies::RoadResult& result);
/// Returns a PNG file with one view, displayed with the exposure of all views.
/// \param view index of the view
/// \throw OutputError if the picture cannot be drawn
std::string road_view_png(const studies::RoadResult& result, std::size_t view);

/// Returns a picture with all views next to each other, in cd/m^2. Channel Y is the luminance. Channel `reflected` is
/// the part of Y that comes directly from the reflectors, and `veil` the part that is scattered in the eye. R, G and B
/// are linear sRGB values with the lamp as white.
FloatPicture road_picture(const studies::RoadResult& result);

/// Returns a plot of the tool path through one element, for roughing or finishing.
PathPlot tool_path_plot(const studies::FabricationResult& result, bool roughing);

/// Returns a plan of the elements that are cut, coloured by the order in which they are cut. In large arrays, adjacent
/// elements of a row are drawn as one.
MapPlot arrangement_plot(const studies::FabricationResult& result);

/// Returns a plan of the array, coloured by the height of the material that remains above the facets after the
/// programs.
SurfacePlot error_map_plot(const studies::ErrorMap& map);

/// Returns a plot of the forces on the tool against time, with one curve for each axis of the machine.
LinePlot forces_plot(const studies::ForcesResult& result);

/// Returns a plot of the acceleration of the Z axis or of the servo. It covers two revolutions around the largest jump
/// of the acceleration.
LinePlot turning_acceleration_plot(const studies::TurningResult& result);
/// Returns a plot of the deviation of the machined surface from the design, along a line across a few cuts.
LinePlot turning_profile_plot(const studies::TurningResult& result);
/// Returns two maps: the height of the designed surface, and the magnitude of the deviation of the machined surface
/// from it.
ImagePlot turning_maps(const studies::TurningResult& result);

/// Returns a plot of the depth against the distance from the centre. It shows the design and the machined surface. For
/// a lathe, the machined surface consists of the straight chords that the programs cut.
LinePlot planing_profile_plot(const studies::PlaningResult& result);
/// Returns a plot of the end points of cuts. For a mill, it shows the strokes, coloured by the set of programs that
/// contains them. For a lathe, it shows the end points of the chords.
LinePlot planing_zones_plot(const studies::PlaningResult& result);
/// Returns a plot of the height of the remaining material above the design, against the distance from the centre.
/// \pre the part is cut on a mill
LinePlot planing_error_plot(const studies::PlaningResult& result);

}  // namespace retrace::report
