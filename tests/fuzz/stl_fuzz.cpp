// For any STL file, the reader either returns a mesh or throws an InputError of one line. A mesh either becomes a part
// or causes an InputError of one line.

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/error.h"
#include "geometry/io/stl_file.h"
#include "geometry/part/mesh_part.h"
#include "tests/fuzz/one_line.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace retrace;
  try {
    const geometry::TriangleMesh mesh =
        geometry::parse_stl(std::string_view(reinterpret_cast<const char*>(data), size), "fuzz.stl");
    const geometry::ClosedMesh closed = geometry::with_openings_closed(mesh);
    geometry::part_of_mesh(closed.mesh);
  } catch (const InputError& error) {
    retrace::fuzz::require_one_line(error);
  }
  return 0;
}
