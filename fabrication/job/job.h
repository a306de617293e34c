#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/part_spec.h"
#include "geometry/vec.h"

namespace retrace::fabrication {

/// What is cut. `mould`: the material on the far side of the part's back, in the part's frame. `direct`: the optic
/// itself, turned by 180 degrees about the part's y axis, so that the array is mirrored in x.
enum class WorkpieceKind { mould, direct };

enum class Strategy {
  unidirectional,  ///< plunge along facet 1, plough along facet 2
  bidirectional,   ///< plunges along both facets, layer by layer
  two_step         ///< unidirectional roughing, bidirectional finishing
};

/// Words of files and commands, in the order of the enumerators.
inline constexpr std::string_view kWorkpieceWords[] = {"mould", "direct"};
inline constexpr std::string_view kStrategyWords[] = {"unidirectional", "bidirectional", "two-step"};

struct Workpiece {
  WorkpieceKind kind = WorkpieceKind::mould;
  double shrinkage_percent = 0.0;  ///< the mould is larger than the part by this much; 0..10
};

/// Single-point inverted cutting tool (thesis 2.1): a diamond whose clearance face looks at the plunged facet. The
/// clearance comes from how the tool is mounted.
struct Tool {
  double width_mm = 0.0;            ///< of the cutting edge; 0.1..2
  double wedge_deg = 50.0;          ///< between clearance and rake face
  double clearance_deg = 3.0;       ///< between clearance face and plunged facet; 2..15
  double edge_radius_um = 0.0;      ///< of the cutting edge; 0: sharp
  double side_clearance_deg = 2.0;  ///< by which the side walls fall back from the edge's ends; > 0
};

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
  double rotary_clearance_mm = 5.0;  ///< above all that the turning blank can reach, before a rotary move
  /// Areal roughness Sa that the motions leave on facets. Milliken 2017 and Hamilton et al. 2017, as measured.
  double plough_sa_nm = 468.0;
  double roughing_plunge_sa_nm = 115.0;
  double finishing_plunge_sa_nm = 48.9;
};

/// Where the elements are, in the part's frame and size.
struct Array {
  geometry::Arrangement arrangement = geometry::Arrangement::single;  ///< single, aligned, offset or checker
  geometry::RowParity shifted_rows = geometry::RowParity::even;
  double overlap_percent = 50.0;
  double x_length_mm = 0.0;  ///< of the extent; for `single`: the element's base and width
  double y_length_mm = 0.0;
  double x_gap_mm = 0.0;
  double y_gap_mm = 0.0;
  double x_offset_mm = 0.0;
  double y_offset_mm = 0.0;
  /// Which cells are cut: one text a row, the row of largest y first, '#' for a cell that is cut and '-' for one that
  /// is not, x rising. Empty: all are. The last column of a shifted row lies beyond the border and counts for nothing.
  std::vector<std::string> pattern;
};

/// A fabrication job: all that a planner or a verifier needs to know, and nothing about light.
struct Job {
  std::string source;  ///< the job file as given; empty if it was made
  std::string title;
  std::string design;  ///< file that the job was made from, for people
  Workpiece workpiece;
  geometry::RtpElement element;  ///< of the part
  Array array;
  Tool tool;
  std::string machine = "ideal";  ///< name of a shipped machine, or a file
  Strategy strategy = Strategy::two_step;
  Process process;
  std::vector<std::string> notes;  ///< remarks of whoever made the job, such as on what it leaves out
};

/// One element that is cut. In the workpiece frame: x_w = y_part, y_w = -x_part, origin at the centre of the extent on
/// the blank's face.
struct CutElement {
  geometry::Vec2 centre_mm = geometry::Vec2::Zero();  ///< of the aperture, in the workpiece frame
  std::int32_t row = 0;                               ///< from 0 at y = 0
  std::int32_t column = 0;                            ///< from 0 at x = 0
  bool turned = false;                                ///< by 90 degrees about z: its roof edge lies along y_w
};

/// Columns and rows of an array's cells.
struct CellCounts {
  std::int64_t columns = 0;
  std::int64_t rows = 0;
};

/// How many cells the extent of an array holds. \pre lengths and sizes > 0
CellCounts cell_counts(const Array& array, const geometry::RtpElement& element);

/// The elements of the job, row by row from y = 0, x rising, in the frame of the blank (a direct workpiece's is
/// mirrored). Partial elements are left out. Their place in the list is their number everywhere. Sizes are the
/// blank's, shrinkage included.
std::vector<CutElement> cut_elements(const Job& job);

/// By how much the blank is larger than the part: 1 + shrinkage_percent / 100.
double blank_scale(const Workpiece& workpiece);

/// The element as it is cut into the blank, shrinkage included.
geometry::RtpElement blank_element(const Job& job);

/// x and y lengths of the array's extent on the blank along x_w and y_w.
geometry::Vec2 blank_extent_mm(const Job& job);

}  // namespace retrace::fabrication
