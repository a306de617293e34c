#pragma once

// Data of a fabrication job: elements and array, workpiece, chisel or V-shaped tool, strategy and process. Also
// computes the list of elements that a job cuts.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/schema/document.h"
#include "core/warning.h"
#include "geometry/elements/part_spec.h"
#include "geometry/outline/outline.h"
#include "geometry/vec.h"

namespace retrace::fabrication {

/// Kind of workpiece. `mould`: the negative shape from which the part is moulded, in the frame of the part. `direct`:
/// the optical part itself, rotated by 180 degrees about the part's y axis, which mirrors the array in x.
enum class WorkpieceKind { mould, direct };

enum class Strategy {
  unidirectional,  ///< plunge along facet 1, plough along facet 2
  bidirectional,   ///< plunges along both facets, layer by layer
  two_step,        ///< unidirectional roughing, bidirectional finishing
  /// Diamond micro chiseling of cube corners: a V-shaped tool moves down one dihedral edge and up another one.
  dmc
};

/// Names of the enumerators in files and commands, in the order of the enumerators.
inline constexpr std::string_view kWorkpieceWords[] = {"mould", "direct"};
inline constexpr std::string_view kStrategyWords[] = {"unidirectional", "bidirectional", "two-step", "dmc"};
inline constexpr std::string_view kNextEdgeWords[] = {"stop", "program"};

struct Workpiece {
  WorkpieceKind kind = WorkpieceKind::mould;
  double shrinkage_percent = 0.0;  ///< excess of the mould's size over the size of the part, in percent; 0..10
};

/// Chip (notch) in the cutting edge. If the last cut of a facet is made with this edge, a ridge remains on the facet at
/// the position of the chip.
struct EdgeChip {
  double position_um =
      0.0;                ///< position of the chip's centre along the edge, from the edge's centre towards machine +X
  double width_um = 0.0;  ///< width of the chip along the edge; > 0
  double depth_um = 0.0;  ///< depth normal to the clearance face; > 0, at most half the width
};

/// Action when an edge has reached its tool life.
enum class NextEdge {
  stop,    ///< the program stops, and the edge is replaced at every stop
  program  ///< a new program begins, and the edge is not replaced at stops
};

/// Diamond tool. For prisms, it is a chisel with a straight edge (single-point inverted cutting, Milliken 2017, section
/// 2.1). For cube corners, it is a V-shaped tool with two edges that meet in the tip (diamond micro chiseling, Milliken
/// 2017, section 1.4.2). The clearance face faces the facet that is cut. The clearance angle is set by the mounting of
/// the tool.
struct Tool {
  double width_mm = 0.0;    ///< chisel: length of the edge, 0.1..2; V-shaped: distance between ends of edges, 0.01..10
  double wedge_deg = 50.0;  ///< angle between clearance face and rake face; 65 by default for a V-shaped tool
  double clearance_deg = 3.0;        ///< angle between clearance face and cut facet, 2..15
  double edge_radius_um = 0.0;       ///< radius of a chisel's edge, or of the nose of a V-shaped tool; 0 if sharp
  double side_clearance_deg = 2.0;   ///< clearance angle of a chisel's side walls behind the ends of the edge; > 0
  double nose_angle_deg = 50.0;      ///< angle between the two edges of a V-shaped tool
  std::vector<EdgeChip> edge_chips;  ///< chips in the edge of a chisel; they do not overlap
  /// Tool life of an edge: maximum path length, in mm, of the tip in cutting moves below the blank's face. If it is
  /// empty, there is no limit.
  std::optional<double> edge_life_mm;
  NextEdge next_edge = NextEdge::stop;  ///< used only if edge_life_mm is given
};

/// Wedge angle, in degrees, of a V-shaped tool with a rake angle of 22 and a clearance angle of 3 degrees (Milliken
/// 2017, section 1.4.2). The three angles add up to 90.
inline constexpr double kDmcWedgeDeg = 65.0;

/// Minimum feed. Programs contain feeds with three decimals. A smaller feed would be rounded to F0.000.
inline constexpr double kMinFeedMmPerMin = 5e-4;

/// Cutting process: depths of cut, feeds, and optional recommendations of Milliken 2017 (the thesis), which are off by
/// default.
struct Process {
  std::string name;
  std::string source;                      ///< source of the values
  double clearance_mm = 0.2;               ///< clearance of the tool above the blank's face, along the face's normal
  double roughing_depth_um = 15.0;         ///< depth of cut (DOC) of roughing and of bidirectional layers
  double finishing_depth_um = 5.0;         ///< DOC of finishing cuts
  int finishing_cuts = 2;                  ///< number of finishing cuts per facet; strategies two-step and dmc only
  double plough_length_mm = 0.1;           ///< length of a plough along facet 2, from the root
  double dwell_s = 0.1;                    ///< dwell time at every root
  double roughing_feed_mm_per_min = 50.0;  ///< feed of plunging and ploughing
  double finishing_feed_mm_per_min = 20.0;
  double retract_feed_mm_per_min = 200.0;  ///< feed of retracts and of moves to the next cut of an element
  bool shortest_plough = false;  ///< true: a plough ends when the chip is free, not at plough_length_mm (thesis 4.4)
  double plough_lift_um = 0.0;   ///< lift of the tool off the facet after the chip has separated; 0 for no lift
  /// Length, in um, of the first part of the retract of a bidirectional cut. This part is made at the cutting feed
  /// (thesis 4.4).
  double slow_retract_um = 0.0;
  bool mist = true;                      ///< true: mist during cuts, which removes chips and cools the edge
  double rotary_clearance_mm = 5.0;      ///< clearance above the rotating blank during rotary moves
  std::optional<double> min_chip_um;     ///< minimum chip thickness, below which the edge rubs; no limit if empty
  std::optional<double> stop_every_min;  ///< maximum run time of a program without a stop; no limit if empty
  bool stop_before_finishing = false;    ///< true: every element is inspected between roughing and finishing
  /// Measured areal roughness Sa of facets after each kind of motion. Source: Milliken 2017 and Hamilton et al. 2017.
  double plough_sa_nm = 468.0;
  double roughing_plunge_sa_nm = 115.0;
  double finishing_plunge_sa_nm = 48.9;
  Warnings warnings;  ///< warnings about the file of the process
};

/// Zone of a job: a group of equal cube corners at given positions. If an optional value is empty, the value of the
/// job's element is used.
struct CutZone {
  std::optional<double> aperture_mm;
  std::optional<std::array<double, 3>> dihedral_error_arcmin;
  std::optional<std::array<double, 3>> facet_tilt_arcmin;
  double rotation_deg = 0.0;              ///< rotation of each element, counter-clockwise seen from +z of the part
  std::vector<geometry::Vec2> apexes_mm;  ///< positions of the apexes in the part frame
};

/// Closed border of a part with an outline, either around the part or around a hole. It has straight sides and circular
/// arcs.
struct JobBorder {
  std::vector<geometry::OutlineSide> sides;
};

/// Outline of a part that is not a rectangle, in the part frame.
struct JobOutline {
  /// Maximum distance between an arc and the sides of the polygon that replaces it.
  double tolerance_mm = 0.005;
  std::vector<JobBorder> borders;  ///< outer border, followed by the borders of holes
};

/// Fabrication job: all data that the planner and the verification need. It contains no optical data.
struct Job {
  std::string source;  ///< path of the job file as given; empty if the job was made by the program
  std::string title;
  std::string design;  ///< name of the design file from which the job was made
  Workpiece workpiece;
  geometry::Element element;           ///< element of the part, without cant
  geometry::AngleErrors angle_errors;  ///< intended angle errors of the elements; cube corners only
  /// Finite array. For a `single` element, the array has the size of the element's aperture. `array.outline` contains
  /// the polygons that replace the borders in `outline`.
  geometry::ArrayLayout array;
  /// Outline of the part; empty for a rectangle. Only elements that are completely inside the outline are cut.
  std::optional<JobOutline> outline;
  /// Zones that are cut instead of the array. If there are zones, only the x and y lengths of `array` are used.
  std::vector<CutZone> zones;
  /// Curved or inclined surface on which the elements are placed, and shape of the blank's face. Its highest point over
  /// the part is z = 0. It is allowed only for moulds of arrays without offsets and patterns. If it is empty, the
  /// blank's face is the plane z = 0.
  std::optional<geometry::Substrate> substrate;
  Tool tool;
  std::string machine = "ideal";  ///< name of a shipped machine, or a file
  Strategy strategy = Strategy::two_step;
  Process process;
  /// Remarks that were added when the job was made, for example about omitted elements.
  std::vector<std::string> notes;
  std::shared_ptr<const schema::Document> document;  ///< content of the job file; null if there is no file
  Warnings warnings;                                 ///< warnings about the job file and the file of its process

  /// Returns the location of a key in the job file. If the key is missing, returns the location of its table.
  InputLocation where(std::string_view key) const;
};

/// Element that is cut, in the workpiece frame: x_w = y_part, y_w = -x_part, origin at the centre of the array's extent
/// on the blank's face.
struct CutElement {
  /// Centre of the aperture, in the workpiece frame. For elements whose axes are normal to a substrate: position on the
  /// unrolled substrate.
  geometry::Vec2 centre_mm = geometry::Vec2::Zero();
  std::int32_t row = 0;     ///< row index, from 0 at y = 0
  std::int32_t column = 0;  ///< column index, from 0 at x = 0
  bool rotated = false;  ///< true: rotated about z, a prism by 90 degrees (roof edge along y_w), a cube corner by 180
  geometry::Vec3 origin_mm = geometry::Vec3::Zero();  ///< point of the blank's face above the root's centre or the apex
  /// Rotation from an element on a flat blank to this element. Its third column is the element's axis.
  Eigen::Matrix3d workpiece_from_element = Eigen::Matrix3d::Identity();
  /// Number of the orientation. Elements with equal `workpiece_from_element` have equal numbers. In a job with zones,
  /// all elements of a zone have the same number.
  std::int32_t orientation = 0;
  std::size_t zone = 0;  ///< index of the zone in the job; 0 without zones
};

/// Converts the outline of a plan to the form in which a job stores it.
JobOutline job_outline(const geometry::PlanRegion& plan);

/// Returns the plan of the job's part. The margin of the part is as wide as the offset of the array.
/// \param fault set if the outline is invalid; the returned plan must then not be used
/// \pre the job has an outline
geometry::PlanRegion plan_of_outline(const Job& job, std::optional<geometry::OutlineFault>& fault);

/// Returns true if the job cuts prisms with a chisel. Otherwise, it cuts cube corners with a V-shaped tool (strategy
/// `dmc`).
bool cuts_prisms(const Job& job);

/// Returns true if the strategy of the job has finishing cuts.
bool has_finishing_cuts(const Job& job);

/// Returns the prism that a job cuts.
/// \throw InputError if the job cuts cube corners
const geometry::RtpElement& prism_of(const Job& job);
geometry::RtpElement& prism_of(Job& job);

/// Returns the elements of the job in the workpiece frame: row by row with ascending y and x, or zone by zone. The
/// index in the list is the number of the element in all programs and reports. Partial elements are omitted. Sizes
/// include shrinkage. The positions of a direct workpiece are mirrored.
std::vector<CutElement> cut_elements(const Job& job);

/// Returns the size of the blank divided by the size of the part: 1 + shrinkage_percent / 100.
double blank_scale(const Workpiece& workpiece);

/// Returns the number of zones of the job, or 1 for a job without zones.
std::size_t zone_count(const Job& job);

/// Returns the element of the job, or of one of its zones, as it is cut into the blank. Its sizes include shrinkage.
geometry::Element blank_element(const Job& job, std::size_t zone = 0);
/// Returns the intended angle errors of the job's element, or of one of its zones. They are 0 for prisms.
geometry::AngleErrors angle_errors_of(const Job& job, std::size_t zone = 0);
/// Returns the prism of the job as it is cut into the blank. Its sizes include shrinkage.
/// \throw InputError if the job cuts cube corners
geometry::RtpElement blank_prism(const Job& job);

/// Returns the lengths of the array's extent on the blank, along x_w and y_w.
geometry::Vec2 blank_extent_mm(const Job& job);

}  // namespace retrace::fabrication
