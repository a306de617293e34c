#include "geometry/io/step_solid.h"

#include <fmt/format.h>

#include <fstream>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "geometry/io/reader_program.h"
#include "geometry/io/solid_message.h"

namespace retrace::geometry {
namespace {

constexpr std::size_t kMaxReasonBytes = 400;

SolidMesh solid_of_message(SolidMessageReader& reader) {
  SolidMesh solid;
  solid.solids = reader.count();
  for (std::size_t left = reader.count(); left > 0; --left) solid.mesh.vertices.push_back(reader.point());
  for (std::size_t left = reader.count(); left > 0; --left) {
    const bool is_plane = reader.index(2) == 1;
    const Vec3 normal = reader.point();
    const double offset_mm = reader.number();
    solid.planes.push_back(is_plane ? std::optional(FacetPlane{normal, offset_mm}) : std::nullopt);
  }
  for (std::size_t left = reader.count(); left > 0; --left) {
    solid.face_of.push_back(static_cast<std::uint32_t>(reader.index(solid.planes.size())));
    auto& triangle = solid.mesh.triangles.emplace_back();
    for (std::uint32_t& corner : triangle)
      corner = static_cast<std::uint32_t>(reader.index(solid.mesh.vertices.size()));
  }
  return solid;
}

/// Checks the beginning of the file, because OpenCASCADE would need long for some other formats.
void require_step(const std::filesystem::path& file) {
  require_short_file(file, kMaxStepSolidBytes);
  std::string begin(4096, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  begin.resize(static_cast<std::size_t>(stream.gcount()));
  if (begin.find("ISO-10303-21") == std::string::npos)
    throw InputError("not a STEP file: a STEP file must begin with \"ISO-10303-21\"");
}

}  // namespace

SolidMesh read_step_solid(const std::filesystem::path& file, double chord_mm) {
  std::error_code ignored;
  // read_file() reports files that do not exist and folders
  if (!std::filesystem::is_regular_file(file, ignored)) static_cast<void>(read_file(file, kMaxStepSolidBytes));
  try {
    require_step(file);
    const std::string result =
        output_of_reader(kSolidReaderName, {file.string(), shortest(chord_mm)}, "libocct-data-exchange-7.6");
    SolidMessageReader reader(result);
    if (reader.index(2) == static_cast<std::size_t>(SolidResult::refused))
      throw InputError(printable(std::string(reader.remaining()), kMaxReasonBytes));
    return solid_of_message(reader);
  } catch (const InputError& error) {
    throw InputError({file.string(), 0, ""}, error.what());
  } catch (const std::runtime_error& error) {
    throw InputError({file.string(), 0, ""}, fmt::format("cannot be read by OpenCASCADE: {}", error.what()));
  }
}

}  // namespace retrace::geometry
