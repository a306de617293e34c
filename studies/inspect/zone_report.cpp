#include "studies/inspect/zone_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "raytrace/faces/back_surface.h"
#include "raytrace/paths/light_path.h"
#include "raytrace/sampling/entrance_sampler.h"

namespace retrace::studies {
namespace {

using geometry::Vec2;

/// Number of points of the entrance face at which rays start, for each direction.
constexpr int kPlaces = 4096;
constexpr double kIncidences[] = {0.0, 20.0};
constexpr int kAzimuths = 4;
/// Maximum angle to the direction of the source at which light counts as returned. The limit is larger than the
/// acceptance cone, because angle errors may deflect light beyond the cone.
constexpr double kBackDeg = 5.0;

class LateralShiftSampler {
 public:
  LateralShiftSampler(const design::Design& design, const design::OpticalModel& model)
      : zones_(model.part.zones),
        model_(model),
        optics_(model.optics),
        size_mm_(design.zoned()->spec.size_mm),
        surface_(model.part, 0.5 * size_mm_) {
    optics_.facet_scatter = surface_models::Smooth{};
    if (design.zoned()->spec.cutting_outline() != nullptr) sampler_.emplace(model.part);
  }

  /// Sums over the returned light from one direction. Only light that first hits the back in one certain zone counts.
  struct Way {
    double power = 0.0;
    double power_times_mm = 0.0;
    double power_that_changes = 0.0;
  };
  std::vector<Way> follow(double incidence_deg, double azimuth_deg) const {
    raytrace::Illumination from;
    from.incidence = Angle::from_deg(incidence_deg);
    from.azimuth = Angle::from_deg(azimuth_deg);
    std::vector<Way> ways(zones_.size());
    for (int k = 0; k < kPlaces; ++k) add(from, place(k), ways);
    return ways;
  }

 private:
  /// Returns the k-th point of a low-discrepancy sequence on the plate (Roberts 2018, with the plastic number). If the
  /// plate has an outline, the sequence is mapped from the unit square to the area inside the outline.
  Vec2 place(int k) const {
    constexpr double plastic = 1.32471795724474602596;
    const auto part = [&](double step) { return std::fmod(0.5 + (k + 1) * step, 1.0); };
    const std::array<double, 2> at = {part(1.0 / plastic), part(1.0 / (plastic * plastic))};
    if (sampler_) return (*sampler_)(at) + sampler_->centre_mm();
    return Vec2(at[0], at[1]).cwiseProduct(size_mm_);
  }

  /// Returns the zone whose cells contain a facet.
  std::size_t zone_of(std::uint32_t facet) const {
    const std::vector<geometry::PatchCell>& cells = model_.part.patches.front().cells;
    const auto after = std::ranges::upper_bound(cells, facet, {}, &geometry::PatchCell::first_facet);
    auto cell = static_cast<std::size_t>(after - cells.begin()) - 1;
    cell = cells[cell].first_of_element.value_or(static_cast<std::uint32_t>(cell));  // sides of notches and holes
    std::size_t zone = 0;
    for (; cell >= zones_[zone].cells; ++zone) cell -= zones_[zone].cells;
    return zone;
  }

  void add(const raytrace::Illumination& from, const Vec2& entry_mm, std::vector<Way>& ways) const {
    const auto first_hit = [this](const raytrace::SurfaceRay& ray) { return surface_.first_hit(ray); };
    const raytrace::LightPath path =
        raytrace::strongest_path(model_.part, first_hit, 0.5 * size_mm_, optics_, from, kBackDeg, entry_mm);
    if (!path.is_returned) return;
    const auto is_back = [](const raytrace::PathStep& step) { return step.facet.has_value(); };
    const auto first = std::ranges::find_if(path.steps, is_back);
    if (first == path.steps.end()) return;
    const auto last = std::find_if(path.steps.rbegin(), path.steps.rend(), is_back);
    const Vec2 begin = first->at_mm.head<2>();
    const Vec2 end = last->at_mm.head<2>();
    const std::size_t zone = zone_of(first->facet->facet);
    Way& way = ways[zone];
    way.power += path.power;
    way.power_times_mm += path.power * (end - begin).norm();
    if (zone_of(last->facet->facet) != zone) way.power_that_changes += path.power;
  }

  const std::vector<geometry::ZoneElements>& zones_;
  const design::OpticalModel& model_;
  raytrace::Optics optics_;
  Vec2 size_mm_;
  raytrace::BackSurface surface_;
  std::optional<raytrace::EntranceSampler> sampler_;  ///< has a value if the plate has an outline
};

}  // namespace

ZonesReport report_zones(const design::Design& design, const design::OpticalModel& model) {
  const LateralShiftSampler sampler(design, model);
  ZonesReport report;
  for (const geometry::ZoneElements& zone : model.part.zones) report.zones.push_back({zone, std::nullopt});
  if (design.entrance) return report;  // the paths are computed only behind a plane entrance face
  for (const double incidence_deg : kIncidences) {
    double power = 0.0;
    double changed = 0.0;
    const int azimuths = incidence_deg == 0.0 ? 1 : kAzimuths;
    for (int a = 0; a < azimuths; ++a) {
      const std::vector<LateralShiftSampler::Way> ways = sampler.follow(incidence_deg, 360.0 * a / azimuths);
      for (std::size_t z = 0; z < ways.size(); ++z) {
        power += ways[z].power;
        changed += ways[z].power_that_changes;
        if (incidence_deg == 0.0 && ways[z].power > 0.0)
          report.zones[z].lateral_shift_mm = ways[z].power_times_mm / ways[z].power;
      }
    }
    report.crossings.push_back({incidence_deg, power > 0.0 ? changed / power : 0.0});
  }
  return report;
}

}  // namespace retrace::studies
