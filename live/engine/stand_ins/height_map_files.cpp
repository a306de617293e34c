// Replaces the reader of measured height maps by a function that reports an error. The design is the only file that the
// live page can read.
#include "live/engine/stand_ins/absent.h"
#include "surface_models/io/height_map_reader.h"

namespace retrace::surface_models {

HeightMapFile read_height_map(const std::filesystem::path&, const HeightMapOptions&) {
  live::fail_as_absent("no access to other files than the design");
}

}  // namespace retrace::surface_models
