#include <algorithm>
#include <cmath>

#include "core/length_units.h"
#include "core/number_format.h"
#include "report/results/result_plots.h"
#include "studies/closed_loop/verification.h"

namespace retrace::report {

SurfacePlot error_map_plot(const studies::ErrorMap& map) {
  GridPanel panel;
  panel.title = "x_w to the right, y_w up; shown from -" + fixed(map.colour_range_nm, 0) + " to " +
                fixed(map.colour_range_nm, 0) + " nm";
  panel.value_label = "material above the facets (nm)";
  panel.columns = map.field.columns;
  panel.rows = map.field.rows;
  panel.x_size_um = kUmPerMm * map.field.size_mm.x();
  panel.y_size_um = kUmPerMm * map.field.size_mm.y();
  panel.values = map.field.height_nm;
  for (double& value : panel.values)
    if (std::isfinite(value)) value = std::clamp(value, -map.colour_range_nm, map.colour_range_nm);
  return {"Material that the programs leave", {std::move(panel)}};
}

}  // namespace retrace::report
