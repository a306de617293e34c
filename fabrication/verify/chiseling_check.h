#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fabrication/job/job.h"
#include "fabrication/read/nc_motion.h"
#include "fabrication/verify/groove.h"
#include "fabrication/verify/swept_volume.h"

namespace retrace::fabrication {

/// Follows the V-shaped motions of diamond micro chiseling: dwells, depths of cut, and whether chips come free
/// (docs/theory/micro_chiseling.md).
class ChiselingCheck {
 public:
  using Report = std::function<void(std::string kind, const NcPlace& place, std::int64_t element, std::string message,
                                    double value, double limit)>;

  ChiselingCheck(const Job& job, const std::vector<Groove>& cavities, double tolerance_mm, Report report);

  /// A feed move within the material of an element. \param back from the frame of the machine to the workpiece's
  void move(const SweptVolume& sweep, const RigidMotion& back, const ToolWedge& wedge, std::size_t element);
  void dwell(double seconds);
  /// The tool has left the material, or turned, or the program ends.
  void close();
  /// After the last program: chips that hang on.
  void finish();

 private:
  /// Down one edge to the apex of a layer, and up the other.
  struct OpenCut {
    std::size_t element = 0;
    std::size_t facet = 0;
    std::array<double, 3> tip_mm{};  ///< heights of the tip over the facets
    NcPlace place;
    bool has_dwell = false;
    bool went_up = false;
  };
  /// What stands on the facets of an element.
  struct State {
    std::array<double, 3> left_mm{};
    NcPlace last;
  };

  void open(const SweptVolume& sweep, const RigidMotion& back, const ToolWedge& wedge, std::size_t element);
  void check_layer(const OpenCut& cut, const State& state);

  const Job& job_;
  const std::vector<Groove>& cavities_;
  double tolerance_mm_ = 0.0;
  Report report_;
  std::vector<State> states_;
  std::optional<OpenCut> open_;
};

}  // namespace retrace::fabrication
