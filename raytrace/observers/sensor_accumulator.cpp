#include "raytrace/observers/sensor_accumulator.h"

namespace retrace::raytrace {

void SensorAccumulator::on_exit(const ExitEvent& departure) {
  if (!departure.is_through_entrance()) return;
  const double power = departure.light.power();
  if (departure.is_front_reflection)
    on_front_reflection(path_, departure.position, departure.direction, power);
  else
    on_exit(path_, departure.position, departure.direction, power);
}

void SensorAccumulator::on_exit(std::uint32_t owner, const Vec3& position, const Vec3& direction, double power) {
  CameraSample& path = paths_[owner];
  const Vec3& from = scene_.film ? path.contact.world : position;
  const Vec3 towards = path.contact.world_from_local * direction;
  const double lamp = path.is_corrected ? path.gain * luminaire_.luminance(from, towards, scene_.correction.blur)
                                        : luminaire_.luminance(from, towards);
  path.luminance += power * (scene_.surroundings.entrance_side + lamp);
}

void SensorAccumulator::on_front_reflection(std::uint32_t owner, const Vec3& from, const Vec3& direction,
                                            double power) {
  CameraSample& path = paths_[owner];
  path.luminance += power * scene_.surroundings.entrance_side;
  if (scene_.has_front_reflection)
    path.luminance += power * luminaire_.luminance(from, path.contact.world_from_local * direction);
}

void SensorAccumulator::on_shell_loss(std::uint32_t owner, double power) {
  paths_[owner].luminance += scene_.surroundings.entrance_side * power;
}

void SensorAccumulator::on_transmission(std::uint32_t owner, double power) {
  paths_[owner].luminance += scene_.surroundings.back_side * power;
}

}  // namespace retrace::raytrace
