#pragma once

// Content of the plots that are drawn into files and on the page of `retrace report`: titles, axes, labels and series.
// The functions take plain values, because the page reads the values from a document and not from a result.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "report/map_plot.h"
#include "report/path_plot.h"
#include "report/plot.h"

namespace retrace::report {

/// RRE for one design, direction of light and acceptance cone.
struct EfficiencyPoint {
  std::string design;  ///< name of the design, different for different designs
  double incidence_deg = 0.0;
  double azimuth_deg = 0.0;
  double acceptance_half_angle_deg = 0.0;
  double rre = 0.0;
  double std_error = 0.0;
  /// Value of the only key in which the designs differ. None if there is no such key or its values are not numbers.
  std::optional<double> design_value = {};
};

/// Maximum number of curves of a plot that are distinguished by a legend. More curves are coloured by the value of a
/// parameter.
inline constexpr std::size_t kMaxCurvesInLegend = 8;

/// Returns a plot of RRE in percent over the angle of incidence, with one curve for each design, azimuth and acceptance
/// cone. If there is only one angle of incidence, the axis is the azimuth. If there is only one direction, the axis is
/// the acceptance half angle. If there are more than kMaxCurvesInLegend curves, a colour scale shows the azimuth, the
/// acceptance half angle or the differing key of the designs. Other parameters are then shown by dashes.
/// \param design_key key of EfficiencyPoint::design_value
/// \pre all angles are finite
LinePlot rre_plot(const std::vector<EfficiencyPoint>& points, const std::string& design_key = {});

/// Measured facets of one process, or a single facet.
struct MeasuredFacets {
  bool is_process = false;  ///< true: a process; false: a single facet
  std::string name;         ///< name of the process
  std::string table;        ///< name of the file with the measured values
  std::size_t facets = 0;   ///< number of facets
  double waviness_sa_nm = 0.0;
};

/// RRE for one roughness of the facets.
struct RoughnessValue {
  double roughness_sa_nm = 0.0;
  double correlation_length_um = 0.0;
  std::optional<MeasuredFacets> measured;  ///< empty: the value belongs to the curve of its correlation length
  double rre = 0.0;
  double std_error = 0.0;
};

/// Returns a plot of RRE over the Sa of the roughness, with a curve for each correlation length and with measured
/// facets as markers.
LinePlot roughness_plot(const std::string& design, const std::vector<RoughnessValue>& values);

/// Cut whose forces are plotted.
struct ForcesOfCut {
  std::string configuration;
  double depth_of_cut_um = 0.0;
  double width_mm = 0.0;
};

/// Returns a plot of the forces on the tool over time. It has one series for each axis of the machine, in the order X,
/// Y, Z. The series are empty; the caller adds the points.
LinePlot forces_plot(const ForcesOfCut& cut);

/// Tool path through one element.
struct ElementPath {
  std::string job;  ///< file name of the job
  std::string machine;
  std::size_t elements = 0;     ///< number of elements that the job cuts
  bool is_roughing = false;     ///< true: roughing; false: all other stages
  bool is_layered = false;      ///< true: the other stages cut layer by layer
  bool is_cube_corner = false;  ///< true: the section is the plane of a facet; false: it is across the root of a prism
};

/// Returns a plot of a tool path with the kinds of moves plunge, plough, retract and translate, in this order. The plot
/// has no moves and no material; the caller adds them.
PathPlot tool_path_plot(const ElementPath& path);

/// Regions of the entrance face that return light from one direction.
struct FootprintValues {
  std::string design;  ///< name of the design; empty if all footprints are of the same design
  double incidence_deg = 0.0;
  std::optional<double> azimuth_deg;  ///< none if the azimuth of all footprints is 0
  double active_fraction = 0.0;       ///< fraction of the area of the entrance face that returns light
  double rre_contribution = 0.0;      ///< RRE that the paths through these regions contribute
};

/// Returns a panel with the texts of a footprint. The panel has no outline and no regions; the caller adds them.
MapPanel footprint_panel(const FootprintValues& footprint);

}  // namespace retrace::report
