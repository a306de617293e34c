#include <fmt/format.h>

#include <filesystem>

#include "core/number_format.h"
#include "report/results/result_plots.h"
#include "studies/metrology/metrology.h"

namespace retrace::report {

SurfacePlot metrology_plot(const studies::MetrologyResult& result) {
  const auto grid = [](const char* what, const auto& map, double sa_nm) {
    return GridPanel{fmt::format("{}: Sa {} nm", what, fixed(sa_nm, 2)),
                     "height (nm)",
                     map.columns,
                     map.rows,
                     static_cast<double>(map.columns) * map.x_pixel_um,
                     static_cast<double>(map.rows) * map.y_pixel_um,
                     map.heights_nm};
  };
  SurfacePlot plot;
  plot.title = fmt::format("{}, cut-off {} µm", std::filesystem::path(result.file).filename().string(),
                           shortest(result.request.cutoff_um));
  plot.panels.push_back(grid("Surface", result.surface, result.of_surface.sa_nm));
  plot.panels.push_back(grid("Roughness", result.split.roughness, result.of_roughness.sa_nm));
  plot.panels.push_back(grid("Waviness", result.split.waviness, result.of_waviness.sa_nm));
  LogPanel spectra{"Power spectral density", "spatial frequency (1/mm)", "PSD (nm² mm)", {}};
  spectra.curves.push_back({"along x", result.along_x.frequency_per_mm, result.along_x.density});
  if (!result.surface.is_profile())
    spectra.curves.push_back({"along y", result.along_y.frequency_per_mm, result.along_y.density});
  plot.panels.push_back(std::move(spectra));
  return plot;
}

}  // namespace retrace::report
