#pragma once

// Measurements of facets that the programs of a job cut, and the values that a machine would produce.

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fabrication/chisel/check/groove.h"
#include "fabrication/machine/edge_cut.h"
#include "studies/fabrication/fabricate.h"

namespace retrace::studies {

inline constexpr double kArcsecPerRad = 180.0 * 3600.0 / std::numbers::pi;

/// Measured quantity of a facet, as the deviation from the design. Distances are positive if material is left. For a
/// cube corner, the horizontal line of a facet replaces the root.
enum class FacetQuantity {
  distance,  ///< distance of the facet's center along its outward normal, nm
  up,        ///< tilt, positive if the facet rises away from the root, arcsec
  along,     ///< tilt, positive if the facet rises along the root, arcsec
  angle,     ///< angle to another facet, measured through the groove, arcsec
  depth,     ///< depth of the root or apex, nm; positive: deeper
  end        ///< height of the end of the last cut above the other facet, at a position along the edge, nm
};
inline constexpr std::string_view kFacetQuantityWords[] = {"distance_nm",  "up_arcsec", "along_arcsec",
                                                           "angle_arcsec", "depth_nm",  "end_nm"};

/// A facet of a part.
struct FacetPlace {
  std::size_t element = 0;  ///< its number, as programs have it
  std::size_t facet = 0;    ///< from 0

  auto operator<=>(const FacetPlace&) const = default;
};

/// One figure that was measured.
struct Measurement {
  std::size_t part = 0;  ///< of those that were cut, each by a job of its own
  FacetPlace at;
  FacetQuantity what = FacetQuantity::distance;
  double value = 0.0;              ///< in the quantity's unit
  double uncertainty = 1.0;        ///< standard, likewise; > 0
  std::optional<FacetPlace> from;  ///< the value is the difference from this facet's; of `angle` the other facet
  double along_edge = 0.0;         ///< of `end`: -1 and 1 at the ends of the edge, 0 in its middle
  int line = 0;                    ///< of the file
  /// Of `distance`: where, up the facet from the root and along that; none: in the facet's middle.
  std::optional<geometry::Vec2> place_mm = {};
};

/// What a map of a part shows of the blank's face about the middle of what it shows of it: its height over the face,
/// nm, and its tilts, which rise along X and Y of the workpiece, arcsec.
struct FaceFigures {
  geometry::Vec2 middle_mm = geometry::Vec2::Zero();
  geometry::Vec3 value = geometry::Vec3::Zero();
  geometry::Vec3 uncertainty = geometry::Vec3::Ones();  ///< standard
};

/// How a part lies where it is measured, against how it lay when it was cut: small, and never known.
struct PartPose {
  geometry::Vec3 shift_um = geometry::Vec3::Zero();
  geometry::Vec3 turn_arcsec = geometry::Vec3::Zero();  ///< as a vector of rotation
  /// Of a part that is seen from its face: how its facets are turned against that, before, about X and Y.
  geometry::Vec2 face_turn_arcsec = geometry::Vec2::Zero();

  /// Of the face; and of the facets.
  Eigen::Matrix3d face_rotation() const;
  Eigen::Matrix3d rotation() const;
};

/// The facets of a part as its programs ask for them, so that it can be told what any machine makes of them.
class CutPart {
 public:
  /// Facets of these elements alone, ascending.
  CutPart(const FabricationResult& result, const std::vector<std::size_t>& elements);

  /// What is wrong with a measurement of this part; empty: nothing.
  std::string fault_of(const Measurement& measurement) const;
  /// Returns the meaning of a positive value of a measurement, such as "rises towards +Y". Directions are machine axes
  /// at A = C = 0 (or B = C = 0).
  /// \pre fault_of() is empty
  std::string positive_sense(const Measurement& measurement) const;
  /// What would be measured. \pre fault_of() is empty
  double predicted(const Measurement& measurement, const fabrication::Machine& real, const PartPose& pose) const;

 private:
  /// A facet as a machine makes it.
  struct MadeFacet {
    const fabrication::Groove* groove = nullptr;
    std::size_t facet = 0;
    fabrication::CutPlane plane;

    const fabrication::DesignFacet& design() const { return groove->facets[facet]; }
    double height_mm(const geometry::Vec3& at) const { return plane.height_mm(at, design().normal); }
    double rise(const geometry::Vec3& along) const {
      return -plane.normal.dot(along) / plane.normal.dot(design().normal);
    }
  };

  MadeFacet made(const FacetPlace& at, const fabrication::Machine& real, const PartPose& pose) const;
  double of_one(const Measurement& measurement, const FacetPlace& at, const fabrication::Machine& real,
                const PartPose& pose) const;
  double depth_nm(const FacetPlace& at, const fabrication::Machine& real, const PartPose& pose) const;
  double end_nm(const Measurement& measurement, const fabrication::Machine& real) const;

  std::vector<fabrication::Groove> grooves_;
  std::map<std::pair<std::size_t, std::size_t>, fabrication::EdgeCut> cuts_;  ///< the last, by element and facet
  double half_edge_mm_ = 0.0;
};

}  // namespace retrace::studies
