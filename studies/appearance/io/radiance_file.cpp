#include "studies/appearance/io/radiance_file.h"

#include <fmt/format.h>

#include <span>

#include "core/text.h"

namespace retrace::studies {
namespace {

using Leaf = std::pair<std::uint64_t, double>;
constexpr std::uint64_t kBranches = 16;

/// Writes a branch of the tree: a single value, or 16 smaller branches.
/// \param leaves leaves of this branch
/// \param level number of levels below this branch
void write_branch(std::span<const Leaf> leaves, int level, std::string& text) {
  if (leaves.empty()) {
    text += "{0}";
  } else if (level == 0) {
    fmt::format_to(std::back_inserter(text), "{{{:.5g}}}", leaves.front().second);
  } else {
    text += level > 1 ? "{\n" : "{";
    for (std::uint64_t branch = 0; branch < kBranches; ++branch) {
      std::size_t count = 0;
      while (count < leaves.size() && ((leaves[count].first >> (4 * (level - 1))) & 0xF) == branch) ++count;
      write_branch(leaves.first(count), level - 1, text);
      leaves = leaves.subspan(count);
    }
    text += level > 1 ? "\n}" : "}";
  }
}

}  // namespace

std::string radiance_text(const TensorTree& tree, const std::string& name) {
  std::string text = fmt::format(R"(<?xml version="1.0" encoding="UTF-8"?>
<WindowElement>
<WindowElementType>System</WindowElementType>
<FileType>BSDF</FileType>
<Optical>
<Layer>
<Material>
<Name>{}</Name>
<Manufacturer>retrace</Manufacturer>
<DeviceType>Other</DeviceType>
</Material>
<DataDefinition>
<IncidentDataStructure>TensorTree4</IncidentDataStructure>
</DataDefinition>
<WavelengthData>
<LayerNumber>System</LayerNumber>
<Wavelength unit="Integral">Visible</Wavelength>
<SourceSpectrum>CIE Illuminant D65 1nm.ssp</SourceSpectrum>
<DetectorSpectrum>ASTM E308 1931 Y.dsp</DetectorSpectrum>
<WavelengthDataBlock>
<WavelengthDataDirection>Reflection Back</WavelengthDataDirection>
<AngleBasis>LBNL/Shirley-Chiu</AngleBasis>
<ScatteringDataType>BRDF</ScatteringDataType>
<ScatteringData>
)",
                                 markup_text(name));
  write_branch(tree.leaves, tree.level, text);
  return text + R"(
</ScatteringData>
</WavelengthDataBlock>
</WavelengthData>
</Layer>
</Optical>
</WindowElement>
)";
}

}  // namespace retrace::studies
