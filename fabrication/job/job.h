#pragma once

// Fabrication jobs as data: elements and array, workpiece, chisel or V-shaped tool, strategy and process, and the
// elements that a job cuts.

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
#include "geometry/elements/part_spec.h"
#include "geometry/vec.h"

namespace retrace::fabrication {

/// What is cut. `mould`: the material on the far side of the part's back, in the part's frame. `direct`: the optic
/// itself, turned by 180 degrees about the part's y axis, so that the array is mirrored in x.
enum class WorkpieceKind { mould, direct };

enum class Strategy {
  unidirectional,  ///< plunge along facet 1, plough along facet 2
  bidirectional,   ///< plunges along both facets, layer by layer
  two_step,        ///< unidirectional roughing, bidirectional finishing
  dmc              ///< diamond micro chiseling of cube corners: a V-shaped tool down one dihedral edge, up the other
};

/// Words of files and commands, in the order of the enumerators.
inline constexpr std::string_view kWorkpieceWords[] = {"mould", "direct"};
inline constexpr std::string_view kStrategyWords[] = {"unidirectional", "bidirectional", "two-step", "dmc"};
inline constexpr std::string_view kNextEdgeWords[] = {"stop", "program"};

struct Workpiece {
  WorkpieceKind kind = WorkpieceKind::mould;
  double shrinkage_percent = 0.0;  ///< the mould is larger than the part by this much; 0..10
};

/// A piece that has broken out of the cutting edge: every facet that the edge cuts last keeps a ridge there.
struct EdgeChip {
  double position_um = 0.0;  ///< of its middle, from the edge's middle towards +X of the machine
  double width_um = 0.0;     ///< along the edge; > 0
  double depth_um = 0.0;     ///< normal to the clearance face; > 0, at most half the width
};

/// What an edge that has cut its life is followed by.
enum class NextEdge {
  stop,    ///< the program stops, and with every stop the edge's account begins anew
  program  ///< a new program begins; stops leave the edge as it is
};

/// A diamond whose clearance face looks at the facet that it cuts; the clearance comes from how the tool is mounted.
/// For prisms a chisel with a straight edge (single-point inverted cutting, thesis 2.1), for cube corners a V-shaped
/// tool with two edges that meet in its tip (diamond micro chiseling, thesis 1.4.2).
struct Tool {
  double width_mm = 0.0;             ///< of a chisel's edge, 0.1..2; across the ends of a V's two edges, 0.01..10
  double wedge_deg = 50.0;           ///< between clearance and rake face; of a V: behind either edge, 65 by default
  double clearance_deg = 3.0;        ///< between clearance face and cut facet; 2..15
  double edge_radius_um = 0.0;       ///< of a chisel's edge, of a V's nose; 0: sharp
  double side_clearance_deg = 2.0;   ///< by which a chisel's side walls fall back from the edge's ends; > 0
  double nose_angle_deg = 50.0;      ///< between the two edges of a V
  std::vector<EdgeChip> edge_chips;  ///< of a chisel; they keep clear of each other
  /// The way of the tip below the blank's face, in moves that cut, that an edge is good for; nothing: it lasts.
  std::optional<double> edge_life_mm;
  NextEdge next_edge = NextEdge::stop;  ///< of an edge with a life
};

/// The wedge of a V-shaped tool with rake 22 and clearance 3 (thesis 1.4.2): they add up to 90.
inline constexpr double kDmcWedgeDeg = 65.0;

/// Programs say feeds in thousandths of a mm/min: less than half of one would be F0.000, a move that never ends.
inline constexpr double kLeastFeedMmPerMin = 5e-4;

/// How an element is cut: depths, feeds and the thesis's recommendations, which are off by default.
struct Process {
  std::string name;
  std::string source;                      ///< where the values come from
  double clearance_mm = 0.2;               ///< of the tool above the blank's face, normal to it
  double roughing_depth_um = 15.0;         ///< depth of cut (DOC) of roughing, and of bidirectional layers
  double finishing_depth_um = 5.0;         ///< DOC of finishing cuts
  int finishing_cuts = 2;                  ///< per facet; two-step only
  double plough_length_mm = 0.1;           ///< along facet 2, from the root
  double dwell_s = 0.1;                    ///< at every root
  double roughing_feed_mm_per_min = 50.0;  ///< plunging and ploughing
  double finishing_feed_mm_per_min = 20.0;
  double retract_feed_mm_per_min = 200.0;  ///< retracting, and moving to the next cut of an element
  bool shortest_plough = false;  ///< plough only until the chip is free instead of plough_length_mm (thesis 4.4)
  double plough_lift_um = 0.0;   ///< by which the tool leaves the facet once the chip is free; 0: it does not
  double slow_retract_um = 0.0;  ///< of bidirectional cuts: this much straight up at cutting feed first (thesis 4.4)
  bool mist = true;              ///< while the tool cuts, to keep chips off and the edge cool
  double rotary_clearance_mm = 5.0;      ///< above all that the turning blank can reach, before a rotary move
  std::optional<double> least_chip_um;   ///< a cut that is thinner all along rubs; nothing: no cut is too thin
  std::optional<double> stop_every_min;  ///< the longest that a program runs without a stop; nothing: to its end
  bool stop_before_finishing = false;    ///< every element, between its roughing and its finishing
  /// Areal roughness Sa that the motions leave on facets. Milliken 2017 and Hamilton et al. 2017, as measured.
  double plough_sa_nm = 468.0;
  double roughing_plunge_sa_nm = 115.0;
  double finishing_plunge_sa_nm = 48.9;
};

/// A group of equal cube corners at given positions. An empty value means that the value of the job's element applies.
struct CutZone {
  std::optional<double> aperture_mm;
  std::optional<std::array<double, 3>> dihedral_error_arcmin;
  std::optional<std::array<double, 3>> facet_tilt_arcmin;
  double rotation_deg = 0.0;              ///< rotation of each element, counter-clockwise seen from +z of the part
  std::vector<geometry::Vec2> apexes_mm;  ///< positions of the apexes in the part frame
};

/// A fabrication job: all that a planner or a verifier needs to know, and nothing about light.
struct Job {
  std::string source;  ///< the job file as given; empty if it was made
  std::string title;
  std::string design;  ///< file that the job was made from, for people
  Workpiece workpiece;
  geometry::Element element;           ///< of the part, without cant
  geometry::AngleErrors angle_errors;  ///< intended errors of angle; cube corners only
  geometry::ArrayLayout array;         ///< finite; x and y lengths of `single` are those of the element's aperture
  /// Zones that are cut instead of the array. If there are zones, `array` only defines the extent. Empty: the array is
  /// cut.
  std::vector<CutZone> zones;
  /// What the elements stand on, of moulds and of arrays without offsets and patterns; its highest place over the part
  /// is z = 0, and the blank's face has its shape. None: the plane z = 0.
  std::optional<geometry::Substrate> substrate;
  Tool tool;
  std::string machine = "ideal";  ///< name of a shipped machine, or a file
  Strategy strategy = Strategy::two_step;
  Process process;
  std::vector<std::string> notes;  ///< remarks from when the job was made, such as on what it leaves out
  std::shared_ptr<const schema::Document> document;  ///< what the file says; none of a job that was made

  /// Where a key was given, or would be missed.
  InputLocation where(std::string_view key) const;
};

/// One element that is cut. In the workpiece frame: x_w = y_part, y_w = -x_part, origin at the centre of the extent on
/// the blank's face.
struct CutElement {
  /// Of the aperture, in the workpiece frame; of an array on a base with its elements along the normal the place on the
  /// sheet that the base is when it is rolled out.
  geometry::Vec2 centre_mm = geometry::Vec2::Zero();
  std::int32_t row = 0;     ///< from 0 at y = 0
  std::int32_t column = 0;  ///< from 0 at x = 0
  bool rotated = false;     ///< a prism by 90 degrees about z: its roof edge lies along y_w; a cube corner by 180
  geometry::Vec3 foot_mm = geometry::Vec3::Zero();  ///< on the blank: the middle of the aperture, or over the apex
  /// Turns directions of an element on a flat blank into those of this one: the third column is its axis.
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  /// Equal for elements with the same `turn`; in a job with zones, for the elements of one zone.
  std::int32_t orientation = 0;
  std::size_t zone = 0;  ///< index of the zone in the job; 0 without zones
};

/// The prism that a job cuts. \throw InputError if it cuts cube corners
const geometry::RtpElement& prism_of(const Job& job);
geometry::RtpElement& prism_of(Job& job);

/// Returns the elements of the job in the workpiece frame: row by row with ascending y and x, or zone by zone. The
/// index in the list is the number of the element in all programs and reports. Partial elements are omitted. Sizes
/// include shrinkage. The positions of a direct workpiece are mirrored.
std::vector<CutElement> cut_elements(const Job& job);

/// By how much the blank is larger than the part: 1 + shrinkage_percent / 100.
double blank_scale(const Workpiece& workpiece);

/// Returns the number of zones of the job, or 1 for a job without zones.
std::size_t zone_count(const Job& job);

/// Returns the element of the job, or of one of its zones, with the sizes that are cut into the blank. They include
/// shrinkage.
geometry::Element blank_element(const Job& job, std::size_t zone = 0);
/// Returns the intended errors of angle of the element. They are 0 for prisms.
geometry::AngleErrors angle_errors_of(const Job& job, std::size_t zone = 0);
/// The same of prisms. \throw InputError if the job cuts cube corners
geometry::RtpElement blank_prism(const Job& job);

/// x and y lengths of the array's extent on the blank along x_w and y_w.
geometry::Vec2 blank_extent_mm(const Job& job);

}  // namespace retrace::fabrication
