#pragma once

// Measurements of facets that the programs of a job cut, and the values that a machine would produce.

#include <Eigen/Core>
#include <cstddef>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fabrication/chisel/check/cavity.h"
#include "fabrication/machine/edge_cut.h"
#include "studies/fabrication/fabricate.h"

namespace retrace::studies {

/// Measured quantity of a facet, as the deviation from the design. Distances are positive if excess material remains.
/// The root is the line at the bottom of a groove, where its two facets meet. For a cube corner, the horizontal line of
/// a facet replaces the root.
enum class FacetQuantity {
  distance,    ///< distance of the facet's center along its outward normal, nm
  tilt_up,     ///< tilt, positive if the facet rises away from the root, arcsec
  tilt_along,  ///< tilt, positive if the facet rises along the root, arcsec
  angle,       ///< angle between this facet and another facet, measured outside of the material, arcsec
  depth,       ///< depth of the root or apex, positive if it is too deep, nm
  cut_end      ///< height of the end of the last cut above the element's other facet, at a position along the edge, nm
};
inline constexpr std::string_view kFacetQuantityWords[] = {"distance_nm",  "up_arcsec", "along_arcsec",
                                                           "angle_arcsec", "depth_nm",  "end_nm"};

/// Facet of a part.
struct FacetId {
  std::size_t element = 0;  ///< number of the element in the programs
  std::size_t facet = 0;    ///< index of the facet, from 0

  auto operator<=>(const FacetId&) const = default;
};

/// Measured value.
struct Measurement {
  std::size_t part = 0;  ///< index of the part, in the order of the jobs
  FacetId at;
  FacetQuantity what = FacetQuantity::distance;
  double value = 0.0;        ///< measured value, in the unit of the quantity
  double uncertainty = 1.0;  ///< standard uncertainty, in the unit of the quantity; > 0
  /// Reference facet: the measured value is the difference from the value of this facet. For `angle`, it is the other
  /// facet of the angle.
  std::optional<FacetId> from;
  double along_edge = 0.0;  ///< for `cut_end`: position along the edge; -1 and 1 at its ends, 0 at its centre
  int line = 0;             ///< line in the file; 0 for values from height maps
  /// For `distance`: position on the facet, up the facet from the root and along the root. If it is empty, the distance
  /// is measured at the centre of the facet.
  std::optional<geometry::Vec2> position_mm = {};
};

/// Height and tilts of the blank's face in a height map, at the centroid of the measured points of the face. The height
/// is relative to the nominal face, in nm. The tilts, in arcsec, are positive if the face rises along X and Y of the
/// workpiece.
struct FaceFigures {
  geometry::Vec2 centroid_mm = geometry::Vec2::Zero();
  geometry::Vec3 value = geometry::Vec3::Zero();
  geometry::Vec3 uncertainty = geometry::Vec3::Ones();  ///< standard uncertainties of the values
};

/// Pose of a part during its measurement, relative to its pose during cutting. It is small and unknown.
struct PartPose {
  geometry::Vec3 shift_um = geometry::Vec3::Zero();
  geometry::Vec3 rotation_arcsec = geometry::Vec3::Zero();  ///< rotation vector
  /// For height maps: rotation of the facets relative to the blank's face, about X and Y. It is not 0 if the face was
  /// not exactly perpendicular to Z in the machine. It is applied before `rotation_arcsec`.
  geometry::Vec2 face_rotation_arcsec = geometry::Vec2::Zero();

  /// Rotation matrices of the blank's face (face_rotation()) and of the facets (rotation()).
  Eigen::Matrix3d face_rotation() const;
  Eigen::Matrix3d rotation() const;
};

/// Facets of a part as its programs cut them. They are used to predict the measurements for any machine.
class CutPart {
 public:
  /// \param elements numbers of the elements to use, in ascending order; all elements if it is empty
  CutPart(const FabricationResult& result, const std::vector<std::size_t>& elements);

  /// Returns the reason why a measurement is not possible for this part. Empty if it is possible.
  std::string obstacle_for(const Measurement& measurement) const;
  /// Returns the meaning of a positive value of a measurement, such as "rises towards +Y". Directions are machine axes
  /// at A = C = 0 (or B = C = 0).
  /// \pre obstacle_for() is empty
  std::string positive_sense(const Measurement& measurement) const;
  /// Returns the value that would be measured.
  /// \param real machine that cut the part
  /// \pre obstacle_for() is empty
  double predicted(const Measurement& measurement, const fabrication::Machine& real, const PartPose& pose) const;

 private:
  /// Facet as cut by a machine.
  struct MachinedFacet {
    const fabrication::Cavity* cavity = nullptr;
    std::size_t facet = 0;
    fabrication::CutPlane plane;

    const fabrication::DesignFacet& design() const { return common(*cavity).facets[facet]; }
    double height_mm(const geometry::Vec3& at) const { return plane.height_mm(at, design().normal); }
    double rise(const geometry::Vec3& along) const {
      return -plane.normal.dot(along) / plane.normal.dot(design().normal);
    }
  };

  /// Returns the facet as the given machine cuts it, displaced by the pose of the part.
  MachinedFacet machined_facet(const FacetId& at, const fabrication::Machine& real, const PartPose& pose) const;
  /// Returns the value of a quantity for one facet. The value of the reference facet is not subtracted. depth_nm() and
  /// end_nm() return the values of FacetQuantity::depth and FacetQuantity::cut_end.
  double of_one(const Measurement& measurement, const FacetId& at, const fabrication::Machine& real,
                const PartPose& pose) const;
  double depth_nm(const FacetId& at, const fabrication::Machine& real, const PartPose& pose) const;
  double end_nm(const Measurement& measurement, const fabrication::Machine& real) const;

  std::vector<fabrication::Cavity> cavities_;
  std::map<std::pair<std::size_t, std::size_t>, fabrication::EdgeCut> cuts_;  ///< last cuts, by element and facet
  double half_edge_mm_ = 0.0;
};

}  // namespace retrace::studies
