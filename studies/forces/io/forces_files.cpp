#include "studies/forces/io/forces_files.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/csv.h"
#include "core/json_text.h"
#include "core/message_text.h"
#include "core/number_format.h"

namespace retrace::studies {
namespace {

using namespace fabrication;
using Json = nlohmann::ordered_json;

std::string_view phase_word(ForcePhase phase) {
  return kForcePhaseWords[static_cast<std::size_t>(phase)];
}

}  // namespace

std::string forces_json(const ForcesResult& result) {
  const CutConditions& cut = result.cut;
  const ForceEvents& e = result.events;
  Json profile = Json::array();
  for (const ForceSample& s : result.profile)
    profile.push_back({{"time_s", s.time_s},
                       {"phase", phase_word(s.phase)},
                       {"engaged_mm", s.engaged_mm},
                       {"fx_n", s.fx_n},
                       {"fy_n", s.fy_n},
                       {"fz_n", s.fz_n}});
  const Json json = {{"job", result.request.job},
                     {"configuration", result.request.configuration},
                     {"depth_of_cut_um", cut.depth_of_cut_um},
                     {"width_mm", cut.width_mm},
                     {"plunge_mm", cut.plunge_mm},
                     {"feed_mm_per_min", cut.feed_mm_per_min},
                     {"full_chip_fy_n", e.full_chip_fy_n},
                     {"full_chip_fz_n", e.full_chip_fz_n},
                     {"before_root_fz_n", e.before_root_fz_n},
                     {"root_fx_n", e.root_fx_n},
                     {"root_fz_n", e.root_fz_n},
                     {"peak_fy_n", e.peak_fy_n},
                     {"profile", std::move(profile)}};
  return result_text("retrace.forces/1", json, result.warnings);
}

std::string forces_csv(const ForcesResult& result) {
  CsvWriter csv("time_s,phase,engaged_mm,fx_n,fy_n,fz_n");
  for (const ForceSample& s : result.profile)
    csv.row(s.time_s, phase_word(s.phase), s.engaged_mm, s.fx_n, s.fy_n, s.fz_n);
  return csv.text();
}

std::string forces_table(const ForcesResult& result) {
  const CutConditions& cut = result.cut;
  const ForceEvents& e = result.events;
  std::string text = fmt::format("{}: {} cut of {} um over {} mm, {} mm deep\n",
                                 printable(result.request.job, std::string::npos), result.request.configuration,
                                 shortest(cut.depth_of_cut_um), shortest(cut.width_mm), fixed(cut.plunge_mm, 4));
  const auto row = [&](const char* name, double force) {
    text += fmt::format("  {:<26} {:>8} N\n", name, fixed(force, 3));
  };
  row("full chip load, Fz", e.full_chip_fz_n);
  row("full chip load, Fy", e.full_chip_fy_n);
  row("before the root, Fz", e.before_root_fz_n);
  row("root, Fz", e.root_fz_n);
  row("root, Fx", e.root_fx_n);
  row(cut.strategy == Strategy::bidirectional ? "retract peak, Fy" : "plough peak, Fy", e.peak_fy_n);
  return text;
}

}  // namespace retrace::studies
