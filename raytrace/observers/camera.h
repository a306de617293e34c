#pragma once

// Pictures of a lit part as an eye or a camera sees it, traced backwards from the pupil.

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/angle.h"
#include "core/progress.h"
#include "geometry/part/part.h"
#include "raytrace/light/optics.h"
#include "raytrace/light/path_policy.h"

namespace retrace::raytrace {

// The frame of cameras is that of the part, with its origin over the centre of the entrance face: x to the right and y
// up as seen from above the face, z = part.thickness_mm on it.

/// A perspective camera that is focused on a point.
struct CameraView {
  geometry::Vec3 eye_mm = geometry::Vec3::UnitZ();
  geometry::Vec3 target_mm = geometry::Vec3::Zero();
  geometry::Vec3 up = geometry::Vec3::UnitY();  ///< not along the view
  double width_mm = 1.0;                        ///< of what it sees across the view at the target; > 0
  std::size_t columns = 1;                      ///< of square pixels
  std::size_t rows = 1;
  Angle pupil;  ///< diameter of its pupil as seen from the target; >= 0
};

/// A disc that faces the target, of the same luminance all over.
struct LampDisc {
  geometry::Vec3 position_mm = geometry::Vec3::UnitZ();
  double illuminance_lx = 0.0;  ///< across the beam, at the target; >= 0
  Angle diameter;               ///< as seen from the target; > 0 if the pupil is a point
};

/// Even luminances round the part, cd/m^2.
struct Surroundings {
  double front = 0.0;   ///< seen by what leaves through the entrance face
  double behind = 0.0;  ///< seen by what leaves elsewhere, and by what misses the part
};

/// A thin sheet of an infinite part, bent over a body. Light is followed within the plane that touches the body where
/// it enters, which leaves out terms of the order of an element's size over the radius.
struct Film {
  double width_mm = 0.0;            ///< along its x, round the cylinder
  double height_mm = 0.0;           ///< along its y, the cylinder's axis
  std::optional<double> radius_mm;  ///< of the cylinder: > 0 bulges towards the light, < 0 is hollow; none: a plane
};

/// How the discs of lamp and pupil are averaged over: in closed form by ApertureKernel, or point by point.
enum class DiscAverage { kernel, sampled };

struct CameraScene {
  CameraView view;
  LampDisc lamp;
  Surroundings surroundings;
  std::optional<Film> film;  ///< infinite parts
  DiscAverage discs = DiscAverage::kernel;
};

/// The optics at one of the wavelengths of the lamp.
struct WeighedOptics {
  Optics optics;
  double weight = 1.0;  ///< share of the flux; they add to 1
};

/// One pass over a picture: luminance (cd/m^2) of the pixels, row by row from above, the share of each that shows the
/// part, and the sum of the luminances of all that shows it.
using CameraPass = std::vector<double>;

/// A picture that gets better pass by pass. Passes are independent of each other.
struct CameraImage {
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::uint32_t passes = 0;
  std::vector<double> luminance;   ///< mean over the passes, cd/m^2, row by row from above
  std::vector<double> squares;     ///< sum of squared deviations from it
  std::vector<double> coverage;    ///< share of each pixel that shows the part
  std::vector<double> part_means;  ///< of each pass: luminance over all that shows the part; empty if nothing does
  std::uint64_t paths = 0;

  /// Takes in the pass that is numbered `passes`.
  void add(const CameraPass& pass);
  /// Standard error of a pixel: what the spread of its passes says, or the mean of that over the pixels round it (two
  /// on either side) where that is larger and the pixel shows the part. A pixel may have missed the few bright paths
  /// that its neighbours met; its own passes then know of no error. \pre passes > 1
  double std_error(std::size_t pixel) const;
  /// Of the part as a whole, with its standard error.
  double part_mean() const;
  double part_error() const;
  /// Mean standard error over mean luminance, of pixels wholly of the part.
  double relative_noise() const;

 private:
  /// Squared, by the pixel's own passes.
  double own_variance(std::size_t pixel) const { return squares[pixel] / (passes - 1.0) / passes; }
};

/// How cameras follow paths: both branches of an interface down to far less power than where efficiencies are asked
/// for. A lamp is some 1e5 times as bright as what else is seen, so that a branch of 1e-4 of the power still matters.
inline constexpr PathPolicy kCameraPolicy{.split_power = 1e-4};

/// How paths are followed: many together by the cell engine where that serves (CellArray::make()), those that meet
/// borders one by one by Embree; or all one by one.
enum class CameraEngine { fastest, embree };

/// Traces light backwards from the pupil through the part, with the same walkers as all other light: what a path would
/// carry from the lamp to the eye it carries from the eye to the lamp (docs/theory/images.md).
class CameraTracer {
 public:
  /// Points of a pixel in a pass, spread evenly.
  static constexpr std::uint32_t kPointsPerPass = 4;

  /// \pre a film if and only if the part is infinite; light is unpolarised; `part` outlives the tracer
  CameraTracer(const geometry::Part& part, const std::vector<WeighedOptics>& light, const CameraScene& scene,
               const PathPolicy& policy, std::uint32_t seed, CameraEngine engine = CameraEngine::fastest);
  ~CameraTracer();

  /// Whether many paths are followed together.
  bool is_by_cells() const;
  CameraImage empty_image() const;
  /// Traces one pass over the picture with all available threads. Returns nothing if it was cancelled. The result
  /// depends only on the seed, the scene and the number of the pass.
  /// In the cell engine, PixelGuide selects half of the points of a pixel where this reduces noise. It is trained with
  /// pass 0 and with a training pass that is not part of the picture. The first call traces both. Only one call may run
  /// at a time.
  /// \throw BudgetError if power is lost
  std::optional<CameraPass> pass(std::uint32_t number, const Cancellation* cancel = nullptr) const;
  /// Adds the next pass; false and nothing added if it was cancelled.
  bool add_pass(CameraImage& image, const Cancellation* cancel = nullptr) const;

 private:
  struct Hidden;
  std::unique_ptr<Hidden> hidden_;
};

}  // namespace retrace::raytrace
