#pragma once

// Internal parts of CameraTracer: the paths of a picture, and the sums of their luminances.

#include <cstdint>
#include <vector>

#include "raytrace/cells/cell_step.h"
#include "raytrace/light/exit_observer.h"
#include "raytrace/observers/camera.h"
#include "raytrace/observers/camera_rays.h"

namespace retrace::raytrace {

/// A path of the camera. It begins where a ray from the pupil meets the part.
struct CameraSample {
  Contact contact;
  double luminance = 0.0;                              ///< luminance along the path, cd/m^2
  double weight = 1.0 / CameraTracer::kPointsPerPass;  ///< weight of the path in the mean of its pixel
  double gain = 1.0;                                   ///< factor of the lamp's light, see ReturnCorrection
  bool is_corrected = false;                           ///< true if ReturnCorrection applies to the path
  bool shows_part() const { return contact.kind == Contact::Kind::face || contact.kind == Contact::Kind::side; }
};

/// Adds the luminance of the lamp and the surroundings to each path, in the direction in which the path leaves the
/// part.
class SensorAccumulator : public ExitObserver, public CellObserver {
 public:
  /// On a film, the lamp is evaluated at the start of the path.
  SensorAccumulator(const Luminaire& luminaire, const CameraScene& scene, std::vector<CameraSample>& paths)
      : luminaire_(luminaire), scene_(scene), paths_(paths) {}

  /// Selects the path to which the following events of PathWalker belong.
  void begin(std::size_t path) { path_ = static_cast<std::uint32_t>(path); }
  void on_exit(const ExitEvent& departure) override;
  void on_exit(std::uint32_t owner, const Vec3& position, const Vec3& direction, double power) override;
  /// Adds the luminance in the direction in which the entrance face reflects the path from outside.
  /// \param from position in the camera frame
  void on_front_reflection(std::uint32_t owner, const Vec3& from, const Vec3& direction, double power);
  void on_transmission(std::uint32_t owner, double power) override;
  /// Adds the luminance of the surroundings for light that a shell reflects, or that leaves the part and misses a
  /// shell. This light is not traced further.
  void on_shell_loss(std::uint32_t owner, double power);

 private:
  const Luminaire& luminaire_;
  const CameraScene& scene_;
  std::vector<CameraSample>& paths_;
  std::uint32_t path_ = 0;
};

}  // namespace retrace::raytrace
