#include "geometry/io/step_solid.h"

#include <fmt/format.h>

#include <optional>
#include <system_error>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "geometry/io/reader_program.h"
#include "geometry/io/step_message.h"

namespace retrace::geometry {
namespace {

constexpr std::size_t kMaxReasonBytes = 400;

SolidMesh solid_of_result(StepMessageReader& reader) {
  SolidMesh solid;
  solid.solids = static_cast<std::size_t>(reader.number());
  solid.mesh.vertices = reader.list<Vec3>([&] { return reader.position(); });
  solid.planes = reader.list<std::optional<FacetPlane>>([&] {
    const bool is_plane = reader.index(2) == 1;
    const Vec3 normal = reader.position();
    const double offset_mm = reader.number();
    return is_plane ? std::optional(FacetPlane{normal, offset_mm}) : std::nullopt;
  });
  solid.mesh.triangles = reader.list<std::array<std::uint32_t, 3>>([&] {
    std::array<std::uint32_t, 3> triangle{};
    for (std::uint32_t& corner : triangle) corner = reader.index(solid.mesh.vertices.size());
    return triangle;
  });
  for (std::size_t left = solid.mesh.triangles.size(); left > 0; --left)
    solid.face_of.push_back(reader.index(solid.planes.size()));
  return solid;
}

}  // namespace

SolidMesh read_step_solid(const std::filesystem::path& file, double chord_mm) {
  std::error_code ignored;
  // read_file() reports files that do not exist, and folders.
  if (!std::filesystem::is_regular_file(file, ignored)) static_cast<void>(read_file(file, kMaxStepBytes));
  try {
    require_short_file(file, kMaxStepBytes);
    const std::string result = result_of_step_program({std::string(kStepSolidWord), file.string(), shortest(chord_mm)});
    StepMessageReader reader(result);
    const auto kind = static_cast<StepResult>(reader.index(static_cast<std::size_t>(StepResult::solid) + 1));
    if (kind == StepResult::refused) throw InputError(printable(reader.text(), kMaxReasonBytes));
    if (kind != StepResult::solid) StepMessageReader::fail();
    return solid_of_result(reader);
  } catch (const InputError& error) {
    throw InputError({file.string(), 0, ""}, error.what());
  } catch (const std::runtime_error& error) {
    throw InputError({file.string(), 0, ""},
                     fmt::format("cannot be read by OpenCASCADE: {}", printable(error.what(), kMaxReasonBytes)));
  }
}

}  // namespace retrace::geometry
