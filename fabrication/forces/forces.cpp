#include "fabrication/forces/forces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/number_format.h"

namespace retrace::fabrication {
namespace {

constexpr double kContactS = 1.0;  ///< time of the first contact in the records
constexpr double kMeasuredFeedMmPerS = 10.0 / 60.0;

using Row = const MeasuredForce&;

const MeasuredForce& row(const std::vector<MeasuredForce>& table, int experiment, const std::string& strategy,
                         double depth_um, const std::string& event) {
  for (const MeasuredForce& r : table)
    if (r.experiment == experiment && r.strategy == strategy && r.event == event &&
        (depth_um <= 0.0 || r.depth_of_cut_um == depth_um))
      return r;
  throw InputError(
      fmt::format("the table of cutting forces has no {} of experiment {}, {}", event, experiment, strategy));
}

double amount(const std::optional<double>& force, Row r, const char* axis) {
  if (!force) throw InputError(fmt::format("the table of cutting forces has no {} for {}", axis, r.event));
  return std::abs(*force);
}

LinearInDepth through(double d1, double f1, double d2, double f2) {
  const double slope = (f2 - f1) / (d2 - d1);
  return {f1 - slope * d1, slope};
}

/// Measurements of experiment 1 at one depth of cut.
struct Record {
  Row chip_z, chip_y, before, root, plough;

  double engaged_mm(Row r) const { return (r.time_s.value_or(kContactS) - kContactS) * kMeasuredFeedMmPerS; }
  double fz(Row r) const { return amount(r.fz_n, r, "fz_n"); }
  double friction() const { return (fz(before) - fz(chip_z)) / (engaged_mm(before) - engaged_mm(chip_z)); }
};

Record record(const std::vector<MeasuredForce>& table, double depth_um) {
  const auto find = [&](const char* event) -> Row { return row(table, 1, "unidirectional", depth_um, event); };
  return {find("full chip fz"), find("full chip fy"), find("before root"), find("root"), find("plough peak")};
}

double um(double mm) {
  return 1e3 * mm;
}

double mm(double micrometres) {
  return 1e-3 * micrometres;
}

bool is_isolated(const CutConditions& cut) {
  return cut.configuration == Configuration::isolated;
}

}  // namespace

ForceModel calibrate(const std::vector<MeasuredForce>& table) {
  ForceModel model;
  const double d1 = model.calibrated_from_um = 5.0;
  const double d2 = model.calibrated_to_um = 10.0;
  const Record a = record(table, d1);
  const Record b = record(table, d2);
  const double w = a.chip_z.width_mm;
  const auto line = [&](auto value) { return through(d1, value(a), d2, value(b)); };
  model.chip_fz_n_per_mm = line([&](const Record& r) { return r.fz(r.chip_z) / w; });
  model.chip_fy_n_per_mm = line([&](const Record& r) { return amount(r.chip_y.fy_n, r.chip_y, "fy_n") / w; });
  model.friction_n_per_mm = line([&](const Record& r) { return r.friction(); });
  model.side_fx_n_per_mm =
      line([&](const Record& r) { return amount(r.root.fx_n, r.root, "fx_n") / r.engaged_mm(r.root); });
  model.root_fz_n_per_mm = line([&](const Record& r) { return (r.fz(r.root) - r.fz(r.before)) / w; });
  model.plough_fy_n_per_mm = line([&](const Record& r) { return amount(r.plough.fy_n, r.plough, "fy_n") / w; });
  model.chip_travel_um = line([&](const Record& r) { return um(r.engaged_mm(r.chip_z)); });
  model.chip_travel_fy_um = line([&](const Record& r) { return um(r.engaged_mm(r.chip_y)); });
  model.root_travel_um = line([&](const Record& r) { return um(r.engaged_mm(r.root) - r.engaged_mm(r.before)); });
  for (const int facet : {1, 2}) {
    const std::string strategy = fmt::format("bidirectional facet {}", facet);
    Row root = row(table, 3, strategy, 0.0, "root");
    Row retract = row(table, 3, strategy, 0.0, "retract peak");
    const auto f = static_cast<std::size_t>(facet - 1);
    model.bidirectional_um = root.depth_of_cut_um;
    model.bidirectional_root_n_per_mm[f] = amount(root.fz_n, root, "fz_n") / root.width_mm;
    model.bidirectional_retract_n_per_mm[f] = amount(retract.fy_n, retract, "fy_n") / retract.width_mm;
  }
  return model;
}

ForceEvents force_events(const ForceModel& model, const CutConditions& cut) {
  const double d = cut.depth_of_cut_um;
  const double friction = is_isolated(cut) ? model.friction_n_per_mm.at(d) : 0.0;
  const double chip_mm = mm(model.chip_travel_um.at(d));
  ForceEvents events;
  events.full_chip_fz_n = -model.chip_fz_n_per_mm.at(d) * cut.width_mm;
  events.full_chip_fy_n = -model.chip_fy_n_per_mm.at(d) * cut.width_mm;
  // The friction force rises from the position of full chip load to the position where the additional force at the root
  // begins. `rising_mm` is the distance between these positions.
  const double rising_mm = std::max(0.0, cut.plunge_mm - mm(model.root_travel_um.at(d)) - chip_mm);
  events.before_root_fz_n = events.full_chip_fz_n - friction * rising_mm;
  events.root_fx_n = is_isolated(cut) ? -model.side_fx_n_per_mm.at(d) * cut.plunge_mm : 0.0;
  if (cut.strategy != Strategy::bidirectional) {
    events.root_fz_n = events.before_root_fz_n - model.root_fz_n_per_mm.at(d) * cut.width_mm;
    events.peak_fy_n = -model.plough_fy_n_per_mm.at(d) * cut.width_mm;
    return events;
  }
  // The forces of bidirectional cuts were measured at one depth of cut with another tool. They are scaled with the
  // cross-section of the chip.
  const auto f = static_cast<std::size_t>(cut.facet - 1);
  const double share = d / model.bidirectional_um * cut.width_mm;
  events.root_fz_n = std::min(events.before_root_fz_n, -model.bidirectional_root_n_per_mm[f] * share);
  events.peak_fy_n = -model.bidirectional_retract_n_per_mm[f] * share;
  return events;
}

std::vector<ForceSample> force_profile(const ForceModel& model, const CutConditions& cut) {
  const ForceEvents events = force_events(model, cut);
  const double d = cut.depth_of_cut_um;
  const double feed = cut.feed_mm_per_min / 60.0;
  const double contact_s = cut.clearance_mm / feed;
  const double root_s = contact_s + cut.plunge_mm / feed;
  const auto fraction_of = [&](double depth, double travel) { return std::clamp(depth / travel, 0.0, 1.0); };
  std::vector<ForceSample> samples = {{0.0, ForcePhase::approach, 0, 0, 0, 0}};
  // Corners of the piecewise linear force during a plunge: first contact, full chip load along Z and along Y, start of
  // the additional force at the root, and the root.
  std::vector<double> corners = {0.0, mm(model.chip_travel_um.at(d)), mm(model.chip_travel_fy_um.at(d)),
                                 cut.plunge_mm - mm(model.root_travel_um.at(d)), cut.plunge_mm};
  for (double& corner : corners) corner = std::clamp(corner, 0.0, cut.plunge_mm);
  std::sort(corners.begin(), corners.end());
  const double rise_mm = mm(model.root_travel_um.at(d));
  const double full_mm = mm(model.chip_travel_um.at(d));
  for (const double depth : corners) {
    const double chip = fraction_of(depth, full_mm) * events.full_chip_fz_n;
    const double friction_share = fraction_of(depth - full_mm, std::max(cut.plunge_mm - rise_mm - full_mm, 1e-9));
    const double friction = friction_share * (events.before_root_fz_n - events.full_chip_fz_n);
    const double root =
        fraction_of(depth - (cut.plunge_mm - rise_mm), rise_mm) * (events.root_fz_n - events.before_root_fz_n);
    samples.push_back({contact_s + depth / feed, ForcePhase::plunge, depth, events.root_fx_n * depth / cut.plunge_mm,
                       fraction_of(depth, mm(model.chip_travel_fy_um.at(d))) * events.full_chip_fy_n,
                       chip + friction + root});
  }
  const ForceSample root = samples.back();
  double now_s = root_s + cut.dwell_s;
  ForceSample end = root;
  end.phase = ForcePhase::dwell;
  end.time_s = now_s;
  samples.push_back(end);
  if (cut.strategy != Strategy::bidirectional) {
    // The chip separates after a distance equal to its thickness. The edge then rubs along the floor.
    const double shear_s = std::min(mm(d), cut.plough_mm) / feed;
    samples.push_back(
        {now_s + shear_s, ForcePhase::plough, cut.plunge_mm, 0.0, events.peak_fy_n, events.full_chip_fz_n});
    now_s += cut.plough_mm / feed;
    samples.push_back({now_s, ForcePhase::plough, cut.plunge_mm, 0.0, events.full_chip_fy_n, events.full_chip_fz_n});
    samples.push_back({now_s, ForcePhase::retract, cut.plunge_mm, 0.0, 0.0, 0.0});
  } else {
    constexpr double spike_s = 0.03;  // measured duration of the peak at the start of the retract (thesis, 4.3.4)
    samples.push_back({now_s + 0.5 * spike_s, ForcePhase::retract, cut.plunge_mm, 0.0, events.peak_fy_n, 0.0});
    samples.push_back({now_s + spike_s, ForcePhase::retract, cut.plunge_mm, 0.0, 0.0, 0.0});
  }
  samples.push_back(
      {now_s + cut.plunge_mm / (cut.retract_feed_mm_per_min / 60.0) + 0.05, ForcePhase::retract, 0, 0, 0, 0});
  return samples;
}

Warnings force_warnings(const ForceModel& model, const CutConditions& cut) {
  Warnings warnings;
  if (cut.depth_of_cut_um < kMinLinearDepthUm)
    warnings.push_back(
        {"depth_below_linear_law", fmt::format("a depth of cut of {} um is below {} um, where the linear force law has "
                                               "not been confirmed by measurements",
                                               shortest(cut.depth_of_cut_um), shortest(kMinLinearDepthUm))});
  if (cut.depth_of_cut_um > model.calibrated_to_um)
    warnings.push_back(
        {"depth_beyond_calibration",
         fmt::format("a depth of cut of {} um is above {} um, the largest measured depth: forces are extrapolated",
                     shortest(cut.depth_of_cut_um), shortest(model.calibrated_to_um))});
  if (cut.strategy == Strategy::bidirectional)
    warnings.push_back({"peaks_of_another_tool",
                        "root and retract peaks of bidirectional cuts were measured at one depth of cut only, and with "
                        "a different tool from that of the other forces"});
  warnings.push_back({"forces_of_one_material",
                      "the computed forces are valid only for aluminium 6061, a wedge angle of 50 degrees and a "
                      "clearance angle of 3 degrees"});
  return warnings;
}

}  // namespace retrace::fabrication
