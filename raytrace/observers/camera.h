#pragma once

// Pictures of an illuminated part as an eye or a camera sees it. Light is traced backwards from the pupil.

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/angle.h"
#include "core/progress.h"
#include "geometry/entrance/entrance_surface.h"
#include "geometry/part/part.h"
#include "raytrace/light/optics.h"
#include "raytrace/light/path_policy.h"
#include "raytrace/observers/return_correction.h"

namespace retrace::raytrace {

// The camera frame has the axes of the part frame. Its origin in x and y is the centre of the entrance face. A plane
// entrance face is the plane z = part.thickness_mm. Seen from above, x points to the right and y up.

/// A perspective camera that is focused on a point.
struct CameraView {
  geometry::Vec3 eye_mm = geometry::Vec3::UnitZ();
  geometry::Vec3 target_mm = geometry::Vec3::Zero();
  geometry::Vec3 up = geometry::Vec3::UnitY();  ///< upward direction of the picture; not parallel to the viewing axis
  double width_mm = 1.0;                        ///< width of the field of view at the target; > 0
  std::size_t columns = 1;                      ///< number of columns of square pixels
  std::size_t rows = 1;
  Angle pupil;  ///< angular diameter of the pupil as seen from the target; >= 0
};

/// A lamp: a disc of uniform luminance that faces the target.
struct LampDisc {
  geometry::Vec3 position_mm = geometry::Vec3::UnitZ();
  double illuminance_lx = 0.0;  ///< illuminance at the target, perpendicular to the beam; >= 0
  Angle diameter;               ///< angular diameter as seen from the target; > 0 if the pupil is a point
};

/// Uniform luminances around the part, in cd/m^2.
struct Surroundings {
  double entrance_side = 0.0;  ///< luminance for paths that leave through the entrance face
  double back_side = 0.0;      ///< luminance for paths that leave through other faces or miss the part

  bool has_light() const { return entrance_side > 0.0 || back_side > 0.0; }
};

/// A thin sheet of an infinite part, bent around a body. Light is traced as in a plane part that is tangent to the film
/// at the point where the light enters. This approximation has a relative error of the order of the element size
/// divided by the radius.
struct Film {
  double width_mm = 0.0;            ///< size along x, around the cylinder
  double height_mm = 0.0;           ///< size along y, the axis of the cylinder
  std::optional<double> radius_mm;  ///< cylinder radius: > 0 if convex towards the light, < 0 if concave; plane film if
                                    ///< not set
};

/// Method of averaging over the discs of lamp and pupil: analytically with ApertureKernel, or by sampling points.
enum class DiscAverage { kernel, sampled };

struct CameraScene {
  CameraView view;
  LampDisc lamp;
  Surroundings surroundings;
  std::optional<Film> film;  ///< set for infinite parts
  DiscAverage discs = DiscAverage::kernel;
  /// Correction of the lamp's light that enters and leaves through the entrance face. Its blur requires
  /// DiscAverage::kernel. For a curved entrance face, the correction has a single gain and no blur. It then applies to
  /// all light that enters through this face, wherever the light leaves.
  ReturnCorrection correction;
  /// True if the picture shows the reflection of the lamp at the outer side of the entrance face.
  bool has_front_reflection = true;
};

/// The optics at one of the wavelengths of the lamp.
struct WeightedOptics {
  Optics optics;
  double weight = 1.0;  ///< fraction of the luminous flux; the weights add up to 1
};

/// Result of one pass over a picture. It contains three values per pixel: all luminances (cd/m^2), then all fractions
/// that show the part, then all numbers of paths. Pixels are ordered row by row from the top. The last element is the
/// luminance of paths through the part, summed over all pixels.
using CameraPass = std::vector<double>;

/// A picture that becomes more accurate with each pass. The passes are independent of each other.
struct CameraImage {
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::uint32_t passes = 0;
  std::vector<double> luminance;   ///< mean over the passes, cd/m^2, row by row from the top
  std::vector<double> squares;     ///< sum of squared deviations from `luminance`
  std::vector<double> coverage;    ///< fraction of each pixel that shows the part
  std::vector<double> paths;       ///< number of paths through each pixel
  std::vector<double> part_means;  ///< per pass: mean luminance of the part; empty if the picture does not show it

  /// Adds the pass with the number `passes`.
  void add(const CameraPass& pass);
  /// Returns the standard error of a pixel, estimated from the differences between passes. Bright paths are rare. A
  /// pixel without a bright path would have a standard error that is too small. The estimate therefore includes the
  /// mean variance of the surrounding 5 x 5 pixels if the pixel shows the part:
  /// - With the minimum number of paths, the pixel's variance is at least this mean variance.
  /// - With more paths, the result is a weighted mean of both variances. The weight of the pixel's own variance
  /// increases with the number of its paths.
  /// \pre passes > 1
  double std_error(std::size_t pixel) const;
  /// Returns the number of paths, summed over all pixels.
  double total_paths() const;
  /// Returns the mean luminance of the part; part_error() returns its standard error.
  double part_mean() const;
  double part_error() const;
  /// Returns the mean standard error divided by the mean luminance, over all pixels that completely show the part. If a
  /// pixel has more than the minimum number of paths, its standard error is estimated without its neighbours. Noisy
  /// pixels are often next to dark pixels, and averaging over the neighbours would overestimate the mean error.
  double relative_noise() const;

 private:
  /// Returns true if more than the minimum number of paths was traced through a pixel.
  bool has_more_paths(std::size_t pixel) const;
  /// Returns the squared standard error, estimated from the pixel's own passes.
  double own_variance(std::size_t pixel) const { return squares[pixel] / (passes - 1.0) / passes; }
};

/// Path policy of cameras. Both branches of an interface (reflected and transmitted light) are traced down to a much
/// lower power than in calculations of efficiencies. The lamp is about 1e5 times as bright as its surroundings, so that
/// branches with 1e-4 of the power are important.
inline constexpr PathPolicy kCameraPolicy{.split_power = 1e-4};

/// Engine that traces the paths. `fastest` uses the cell engine where possible (CellArray::make()) and Embree for paths
/// that meet borders. `embree` traces all paths one by one.
enum class CameraEngine { fastest, embree };

/// Traces light backwards from the pupil through the part. It uses the same walkers (PathWalker, CellWalker) as the
/// tracers of light that starts at a source. By reciprocity, a path transmits the same fraction of light in both
/// directions (docs/theory/images.md).
class CameraTracer {
 public:
  /// Minimum number of points per pixel and pass. These points are evenly distributed over the pixel.
  static constexpr std::uint32_t kPointsPerPass = 4;

  /// \param entrance_face curved entrance face of a finite part, as in MonteCarlo; null for the plane face. Parts with
  ///     a curved face are traced with Embree.
  /// \pre the scene has a film if and only if the part is infinite; light is unpolarized; `part` outlives the tracer;
  /// if `engine` is `fastest`, Optics::has_uniform_backing() is true for all `light`
  CameraTracer(const geometry::Part& part, const std::vector<WeightedOptics>& light, const CameraScene& scene,
               const PathPolicy& policy, std::uint32_t seed, CameraEngine engine = CameraEngine::fastest,
               const geometry::Entrance* entrance_face = nullptr);
  ~CameraTracer();

  /// Returns true if the cell engine is used, which traces many paths together.
  bool is_by_cells() const;
  CameraImage empty_image() const;
  /// Traces one pass over the picture with all available threads. Returns nothing if it was cancelled. The result
  /// depends only on the seed, the scene and the number of the pass.
  ///
  /// With the cell engine, a PixelGuide selects half of the points of a pixel if this reduces the noise. The first call
  /// trains the guide with pass 0 and with a training pass that is not part of the picture. With Embree, noisy pixels
  /// have more points (PixelPoints). Two training passes, which are not part of the picture, determine the numbers of
  /// points.
  /// \pre no other call is running
  /// \throw BudgetError if power is lost
  std::optional<CameraPass> pass(std::uint32_t number, const Cancellation* cancel = nullptr) const;
  /// Traces the next pass and adds it to `image`. Returns false if tracing was cancelled; the image is then unchanged.
  bool add_pass(CameraImage& image, const Cancellation* cancel = nullptr) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace retrace::raytrace
