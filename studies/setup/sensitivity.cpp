#include "studies/setup/sensitivity.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "core/length_units.h"
#include "fabrication/chisel/check/cavity.h"

namespace retrace::studies {
namespace {

using namespace fabrication;
using geometry::Vec3;

constexpr double kArcminPerRad = 180.0 * 60.0 / std::numbers::pi;

/// Cut of a facet, with the plane that it cuts.
class PlacedCut {
 public:
  PlacedCut(const Machine& machine, const FacetEdgeCut& cut, const Cavity& groove)
      : machine_(&machine), cut_(&cut), groove_(&groove) {
    plane_ = cut_plane(machine, cut.cut, design().normal);
  }

  /// Returns the distance by which the facet rises above a position of the design, in mm per unit of the set-up
  /// quantity.
  double height_mm(const PlaneChange& change, const Vec3& at) const {
    return change.height_mm(plane_, at, design().normal);
  }
  PlaneChange change(const SetupQuantity& quantity) const {
    return plane_change(*machine_, cut_->cut, quantity, design().normal);
  }

  const FacetEdgeCut& cut() const { return *cut_; }
  const Cavity& groove() const { return *groove_; }
  const DesignFacet& design() const { return common(*groove_).facets[cut_->facet]; }

 private:
  const Machine* machine_;
  const FacetEdgeCut* cut_;
  const Cavity* groove_;
  CutPlane plane_;
};

FacetEffect effect_of(const PlacedCut& placed, const PlaneChange& change) {
  const Vec3 middle = facet_centre(placed.groove(), placed.cut().facet);
  FacetEffect effect;
  const double at_middle = placed.height_mm(change, middle);
  const auto slope = [&](const Vec3& along) { return placed.height_mm(change, middle + along) - at_middle; };
  effect.distance_nm = kNmPerMm * at_middle;
  effect.up_arcmin = kArcminPerRad * slope(placed.design().up_slope);
  effect.along_arcmin = kArcminPerRad * slope(placed.design().along);
  for (const Vec3& corner : facet_corners(placed.groove(), placed.cut().facet)) {
    const double nm = kNmPerMm * placed.height_mm(change, corner);
    if (std::abs(nm) > std::abs(effect.farthest_nm)) effect.farthest_nm = nm;
  }
  return effect;
}

/// Cuts of a job, by indices of element and facet. Each list is in the order of time.
using CutsOfFacets = std::map<std::pair<std::size_t, std::size_t>, std::vector<PlacedCut>>;

/// Returns the maximum change of the chip thickness over all cuts of a facet except the first. The chip is the material
/// between the planes of the previous cut and of the current one.
double chip_change_nm(const std::vector<PlacedCut>& cuts, const SetupQuantity& quantity) {
  double most = 0.0;
  std::optional<double> before;
  for (const PlacedCut& placed : cuts) {
    const Vec3 middle = facet_centre(placed.groove(), placed.cut().facet);
    const double height = placed.height_mm(placed.change(quantity), middle);
    if (before) most = std::max(most, std::abs(*before - height));
    before = height;
  }
  return kNmPerMm * most;
}

/// Returns the positions of the ends of the cutting edge at the end of a cut, in the workpiece frame. For a V-shaped
/// tool, returns only its tip.
std::vector<Vec3> edge_ends(const Machine& machine, const EdgeCut& cut, double half_width_mm) {
  const RigidMotion back = machine_from_workpiece(machine, rotary_pose(machine, cut.at)).inverse();
  const Vec3 tip = machine_point(machine, cut.at) + edge_frame(machine) * cut.tip_mm;
  if (machine.tilt == Tilt::head) return {back.point(tip)};
  const Vec3 half = half_width_mm * cutting_edge(machine, cut.edge_rise);
  return {back.point(tip - half), back.point(tip + half)};
}

/// Updates `row` with the distance by which the last cut of a facet (`ending`) ends above or below the facet `other`,
/// per unit of a quantity.
void tell_root(const Machine& machine, const PlacedCut& ending, const PlacedCut& other, double half_width_mm,
               const SetupQuantity& quantity, Sensitivity& row) {
  const EdgeCut& cut = ending.cut().cut;
  const std::vector<Vec3> before = edge_ends(machine, cut, half_width_mm);
  const std::vector<Vec3> after = edge_ends(with_error(machine, quantity, 1.0), cut, half_width_mm);
  const PlaneChange change = other.change(quantity);
  for (std::size_t k = 0; k < before.size(); ++k) {
    const double end = other.design().normal.dot(after[k] - before[k]);
    const double over_nm = kNmPerMm * (end - other.height_mm(change, before[k]));
    row.root_residual_nm = std::max(row.root_residual_nm, over_nm);
    row.root_cut_nm = std::max(row.root_cut_nm, -over_nm);
  }
}

/// Returns points of the tool, in the workpiece frame, that may touch the walls at the ends of a groove. They are both
/// ends of the cutting edge at the root, both ends of the edge at the top of both facets, and points one facet length
/// above the ends at the root.
/// \param machine machine that executes the axis positions
/// \param planned machine for which the axis positions were planned
std::vector<Vec3> wall_places(const Machine& machine, const Machine& planned, const PlacedCut& ending,
                              double half_width_mm) {
  const DesignElement& groove = common(ending.groove());
  EdgeCut cut = ending.cut().cut;
  const RigidMotion motion = machine_from_workpiece(planned, rotary_pose(planned, cut.at));
  const AxisPositions at_root = cut.at;
  std::vector<Vec3> places = edge_ends(machine, cut, half_width_mm);
  const Vec3 up =
      machine_from_workpiece(machine, rotary_pose(machine, cut.at)).inverse().direction(edge_frame(machine).col(2));
  for (std::size_t k = 0; k < 2; ++k) places.push_back(places[k] + groove.facet_length_mm * up);
  for (const DesignFacet& facet : groove.facets) {
    const auto words = axis_change_along(planned, groove.facet_length_mm * motion.direction(facet.up_slope));
    cut.at.y_mm = at_root.y_mm + words[1];
    cut.at.z_mm = at_root.z_mm + words[2];
    for (const Vec3& end : edge_ends(machine, cut, half_width_mm)) places.push_back(end);
  }
  return places;
}

/// Updates `row` with the depth by which the ends of the tool cut into the walls, per unit of a quantity. A
/// displacement of the edge along the root moves one of its ends into a wall.
void tell_walls(const Machine& machine, const PlacedCut& ending, double half_width_mm, const SetupQuantity& quantity,
                Sensitivity& row) {
  if (machine.tilt == Tilt::head) return;
  const std::vector<Vec3> before = wall_places(machine, machine, ending, half_width_mm);
  const std::vector<Vec3> after = wall_places(with_error(machine, quantity, 1.0), machine, ending, half_width_mm);
  for (std::size_t k = 0; k < before.size(); ++k)
    row.wall_nm = std::max(row.wall_nm, kNmPerMm * std::abs(ending.design().along.dot(after[k] - before[k])));
}

/// Returns the effects of one set-up quantity.
/// \param ways_up last upward cuts of a V-shaped tool; they machine that part of a facet which the cuts in `cuts` do
/// not reach
Sensitivity row_of(const Machine& machine, double half_width_mm, const SetupQuantity& quantity,
                   const CutsOfFacets& cuts, const CutsOfFacets& ways_up, const std::vector<CutElement>& elements,
                   const std::vector<FacetKind>& kinds) {
  Sensitivity row;
  row.quantity = &quantity;
  row.facets.resize(kinds.size());
  const auto take = [&](std::size_t element, std::size_t facet, const PlacedCut& last) {
    const auto kind = std::find(kinds.begin(), kinds.end(), FacetKind{facet, elements[element].rotated});
    FacetEffect& known = row.facets[static_cast<std::size_t>(kind - kinds.begin())];
    const FacetEffect effect = effect_of(last, last.change(quantity));
    if (std::abs(effect.farthest_nm) > std::abs(known.farthest_nm)) known = effect;
  };
  for (const auto& [place, list] : ways_up) take(place.first, place.second, list.back());
  for (const auto& [place, list] : cuts) {
    const auto& [element, facet] = place;
    take(element, facet, list.back());
    row.chip_nm = std::max(row.chip_nm, chip_change_nm(list, quantity));
    if (!list.back().cut().ends_at_root) continue;
    tell_walls(machine, list.back(), half_width_mm, quantity, row);
    for (std::size_t other = 0; other < common(list.back().groove()).facets.size(); ++other)
      if (const auto found = cuts.find({element, other}); other != facet && found != cuts.end())
        tell_root(machine, list.back(), found->second.back(), half_width_mm, quantity, row);
  }
  return row;
}

std::vector<FacetKind> kinds_of(const CutsOfFacets& cuts, const std::vector<CutElement>& elements) {
  std::vector<FacetKind> kinds;
  for (const auto& [place, list] : cuts) {
    const FacetKind kind{place.second, elements[place.first].rotated};
    if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end()) kinds.push_back(kind);
  }
  std::sort(kinds.begin(), kinds.end(), [](const FacetKind& a, const FacetKind& b) {
    return std::pair(a.rotated, a.facet) < std::pair(b.rotated, b.facet);
  });
  return kinds;
}

}  // namespace

std::string FacetKind::name() const {
  return fmt::format("facet {}{}", facet + 1, rotated ? " of rotated elements" : "");
}

double Sensitivity::farthest_nm() const {
  double most = 0.0;
  for (const FacetEffect& effect : facets) most = std::max(most, std::abs(effect.farthest_nm));
  return most;
}

double Sensitivity::largest_nm() const {
  return std::max({farthest_nm(), chip_nm, root_residual_nm, root_cut_nm});
}

std::vector<std::size_t> outermost_elements(const std::vector<CutElement>& elements) {
  constexpr int kDirections = 8;
  std::set<std::size_t> chosen;
  for (const bool rotated : {false, true}) {
    std::vector<std::size_t> alike;
    for (std::size_t k = 0; k < elements.size(); ++k)
      if (elements[k].rotated == rotated) alike.push_back(k);
    if (alike.empty()) continue;
    const auto add_least = [&](const auto& measure) {
      chosen.insert(*std::min_element(alike.begin(), alike.end(),
                                      [&](std::size_t a, std::size_t b) { return measure(a) < measure(b); }));
    };
    add_least([&](std::size_t k) { return elements[k].origin_mm.norm(); });
    for (int d = 0; d < kDirections; ++d) {
      const double azimuth = 2.0 * std::numbers::pi * d / kDirections;
      const geometry::Vec2 inwards(-std::cos(azimuth), -std::sin(azimuth));
      add_least([&](std::size_t k) { return inwards.dot(elements[k].origin_mm.head<2>()); });
    }
  }
  return {chosen.begin(), chosen.end()};
}

Sensitivities sensitivities(const Job& job, const Machine& machine, const Plan& plan) {
  const std::vector<FacetEdgeCut> cuts = facet_edge_cuts(job, plan, outermost_elements(plan.elements));
  const std::vector<Cavity> grooves = designed_cavities(job);
  CutsOfFacets by_facet;
  CutsOfFacets ways_up;
  for (const FacetEdgeCut& cut : cuts)
    (cut.ends_at_root || cut.is_ploughed ? by_facet : ways_up)[{cut.element, cut.facet}].emplace_back(
        machine, cut, grooves[cut.element]);
  Sensitivities result;
  result.kinds = kinds_of(by_facet, plan.elements);
  for (const SetupQuantity& quantity : setup_quantities(machine.tilt))
    result.rows.push_back(
        row_of(machine, 0.5 * job.tool.width_mm, quantity, by_facet, ways_up, plan.elements, result.kinds));
  std::stable_sort(result.rows.begin(), result.rows.end(),
                   [](const Sensitivity& a, const Sensitivity& b) { return a.largest_nm() > b.largest_nm(); });
  return result;
}

}  // namespace retrace::studies
