#include "studies/image/io/dye_reader.h"

#include <filesystem>

#include "core/named_file.h"
#include "materials/io/spectrum_reader.h"
#include "studies/photometry/io/standard_reader.h"

namespace retrace::studies {

materials::SpectralCurve read_dye(const std::string& dye) {
  const std::filesystem::path file = dye_file_of(dye, false, {});
  if (file.empty()) return {};
  return read_named(Field{"dye"}, [&] { return materials::read_spectral_absorption(file); });
}

}  // namespace retrace::studies
