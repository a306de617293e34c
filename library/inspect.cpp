#include "retrace/inspect.h"

#include <memory>
#include <mutex>

#include "library/content.h"
#include "library/drawing_content.h"
#include "report/drawing/design_drawings.h"
#include "studies/inspect/inspect.h"
#include "studies/inspect/io/inspect_files.h"

namespace retrace {
namespace {

/// Drawings of an inspection. All of them are made when the first one is requested.
struct DrawnLater {
  studies::Inspection inspection;
  std::once_flag once;
  report::DesignDrawings drawings;

  const report::DesignDrawings& made() {
    std::call_once(once, [this] { drawings = report::design_drawings(inspection); });
    return drawings;
  }
};

}  // namespace

Inspection inspect(const Design& design, const InspectRequest& request) {
  const auto held = std::make_shared<DrawnLater>();
  held->inspection = studies::inspect(design.content().design, materials::MaterialLibrary::shipped(), request);
  Inspection result;
  result.warnings = held->inspection.warnings;
  result.json = studies::inspect_json(held->inspection);
  result.table = studies::inspect_text(held->inspection);
  result.plan = drawing_of_text([held] { return held->made().plan; }, true);
  result.section = drawing_of_text([held] { return held->made().section; }, true);
  result.entrance_surface = drawing_of_text([held] { return held->made().entrance; }, true);
  result.shells = drawing_of_text([held] { return held->made().shells; }, true);
  result.pin_axes = drawing_of_text([held] { return held->made().pin_axes; }, true);
  result.view = drawing_of_text([held] { return held->made().view; }, false);
  return result;
}

}  // namespace retrace
