#include "studies/calibration/facet_marks.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>

#include "core/length_units.h"
#include "fabrication/chisel/plan/edge_cuts.h"

namespace retrace::studies {
namespace {

using namespace fabrication;
using geometry::Vec2, geometry::Vec3;
using MapAxis = surface_models::Axis;
using surface_models::HeightMap, surface_models::Scratch, surface_models::SpectralPeak;

/// Maximum distance, in um, between a line of a facet and the neighbouring lines with which it is compared.
constexpr double kBesideUm = 30.0;
/// Minimum number of periods of a wave on a facet. Longer waves count as form of the facet.
constexpr double kMinPeriods = 3.0;
/// Tolerances within which waves of two facets count as the same wave: relative difference of their frequencies, and
/// difference of their numbers of periods on a facet.
constexpr double kSameFrequency = 0.02;
constexpr double kSamePeriods = 0.5;
/// Minimum fraction of facets that must have a mark at the same position, so that the mark is attributed to the tool's
/// edge. Only facets whose measured area contains the position are counted.
constexpr double kMinMarkedFraction = 0.5;
/// Minimum distance, in um, of detectable marks from the ends of the measured area of a facet.
constexpr double kUnseenUm = kBesideUm;

/// Averages the heights of points in the cells of a grid. Cells without points have no height.
HeightMap laid_out(std::span<const Vec3> left, const Vec2& low_mm, const Vec2& high_mm, const Vec2& pitch_mm) {
  const auto cells = [&](Eigen::Index axis) {
    return 1 + static_cast<std::size_t>(std::lround((high_mm[axis] - low_mm[axis]) / pitch_mm[axis]));
  };
  HeightMap map{cells(0), cells(1), kUmPerMm * pitch_mm.x(), kUmPerMm * pitch_mm.y(), {}};
  map.heights_nm.assign(map.columns * map.rows, 0.0);
  std::vector<double> count(map.heights_nm.size(), 0.0);
  for (const Vec3& p : left) {
    const auto cell = [&](Eigen::Index axis) {
      return static_cast<std::size_t>(std::lround((p[axis] - low_mm[axis]) / pitch_mm[axis]));
    };
    const std::size_t at = cell(1) * map.columns + cell(0);
    map.heights_nm[at] += kNmPerMm * p.z();
    count[at] += 1.0;
  }
  for (std::size_t k = 0; k < count.size(); ++k)
    map.heights_nm[k] = count[k] > 0.0 ? map.heights_nm[k] / count[k] : surface_models::kMissing;
  return map;
}

/// Averages the heights of points in the cells of a grid. Points inside of marks are ignored.
HeightMap laid_out(const FacetResiduals& rest, std::span<const Vec3> left) {
  std::vector<Vec3> unmarked;
  for (const Vec3& p : left)
    if (!rest.is_marked(p.head<2>())) unmarked.push_back(p);
  return laid_out(unmarked, rest.low_mm, rest.high_mm, rest.pitch_mm);
}

/// Returns the coordinate axis perpendicular to a mark: 0 for x, 1 for y.
Eigen::Index across(MapAxis along) {
  return along == MapAxis::y ? 0 : 1;
}

/// Wave or mark of a facet, used to collect the waves and marks that several facets have in common.
template <class Thing>
struct Found {
  const FacetResiduals* rest = nullptr;
  Thing thing;
};

/// Returns the length of the measured area of the facet in the direction of the wave, in mm. Multiplied by the
/// frequency of the wave, it gives the number of periods.
double periods(const Found<SpectralPeak>& wave) {
  const Eigen::Index axis = wave.thing.axis == MapAxis::x ? 0 : 1;
  return wave.rest->high_mm[axis] - wave.rest->low_mm[axis];
}

/// Returns the common wave of a group of facets: mean frequency and root mean square of the amplitudes.
FacetWave gathered(const std::vector<Found<SpectralPeak>>& waves, double feed_mm_per_min) {
  FacetWave wave;
  wave.is_along_edge = waves.front().thing.axis == MapAxis::x;
  double frequency_per_mm = 0.0;
  double power = 0.0;
  for (const auto& [rest, peak] : waves) {
    frequency_per_mm += peak.frequency_per_mm / static_cast<double>(waves.size());
    power += 2.0 * peak.sq_nm * peak.sq_nm / static_cast<double>(waves.size());
    wave.facets.push_back(rest->at);
  }
  wave.length_um = kUmPerMm / frequency_per_mm;
  wave.amplitude_nm = std::sqrt(power);
  constexpr double kSecondsPerMin = 60.0;
  if (!wave.is_along_edge) wave.frequency_hz = frequency_per_mm * feed_mm_per_min / kSecondsPerMin;
  return wave;
}

/// Returns the common mark of a group of facets: mean position, height and width.
/// \param rests residuals of all facets, to count the facets whose measured area contains the mark
FacetMark gathered(const std::vector<Found<Scratch>>& marks, const std::vector<FacetResiduals>& rests) {
  FacetMark mark;
  const MapAxis along = marks.front().thing.along;
  mark.is_along_cut = along == MapAxis::y;
  for (const auto& [rest, scratch] : marks) {
    const double share = 1.0 / static_cast<double>(marks.size());
    mark.position_um += share * scratch.position_um;
    mark.height_nm -= share * scratch.depth_nm;
    mark.width_um += share * scratch.width_um;
    mark.facets.push_back(rest->at);
  }
  for (const FacetResiduals& rest : rests) {
    const double low_um = kUmPerMm * rest.low_mm[across(along)];
    const double high_um = kUmPerMm * rest.high_mm[across(along)];
    const bool is_of_mark = std::ranges::find(mark.facets, rest.at) != mark.facets.end();
    mark.facets_covering +=
        is_of_mark || (low_um + kUnseenUm < mark.position_um && mark.position_um < high_um - kUnseenUm) ? 1U : 0U;
  }
  mark.is_of_edge =
      mark.is_along_cut && mark.facets.size() > 1 &&
      static_cast<double>(mark.facets.size()) >= kMinMarkedFraction * static_cast<double>(mark.facets_covering);
  return mark;
}

}  // namespace

std::map<FacetId, CutCoordinates> cut_coordinates(const FabricationResult& plan,
                                                  const std::vector<std::size_t>& elements) {
  const std::vector<Cavity> grooves = designed_cavities(plan.job);
  std::map<FacetId, CutCoordinates> views;
  for (const FacetEdgeCut& made : facet_edge_cuts(plan.job, plan.plan, elements)) {
    if (!made.ends_at_root && !made.is_ploughed) continue;
    const DesignElement& groove = common(grooves[made.element]);
    const Vec3& up = groove.facets[made.facet].up_slope;
    const Vec3& level = groove.facets[made.facet].along;
    const EdgeCut& cut = made.cut;
    const RigidMotion back = machine_from_workpiece(plan.machine, rotary_pose(plan.machine, cut.at)).inverse();
    const Vec3 middle = back.point(machine_point(plan.machine, cut.at) + edge_frame(plan.machine) * cut.tip_mm);
    const Vec3 edge = back.direction(cutting_edge(plan.machine, cut.edge_rise));
    Vec3 way = groove.facets[made.facet].normal.cross(edge);
    if (way.dot(up) < 0.0) way = -way;
    const auto seen = [&](const Vec3& v) { return Vec2(edge.dot(v), way.dot(v)); };
    views[{made.element, made.facet}] = {seen(groove.root_mm - middle), seen(up), seen(level)};
  }
  return views;
}

bool FacetResiduals::is_marked(const Vec2& position_mm) const {
  return std::ranges::any_of(marks, [&](const Scratch& mark) {
    const Eigen::Index axis = across(mark.along);
    return std::abs(kUmPerMm * position_mm[axis] - mark.position_um) <= mark.width_um + kUmPerMm * pitch_mm[axis];
  });
}

FacetResiduals marks_of(const FacetId& at, std::span<const Vec3> left, const Vec2& pitch_mm) {
  FacetResiduals rest;
  rest.at = at;
  rest.pitch_mm = pitch_mm;
  if (left.empty()) return rest;
  rest.low_mm = rest.high_mm = left.front().head<2>();
  for (const Vec3& p : left) {
    rest.low_mm = rest.low_mm.cwiseMin(p.head<2>());
    rest.high_mm = rest.high_mm.cwiseMax(p.head<2>());
  }
  // Search the marks one by one, beginning with the deepest one, and exclude the marks that are already found.
  // Otherwise, lines next to a wide mark would be detected as further marks.
  constexpr std::size_t kMaxMarks = 16;
  while (rest.marks.size() < kMaxMarks) {
    const HeightMap map = laid_out(rest, left);
    std::vector<Scratch> found = surface_models::find_scratches(map, MapAxis::x, kBesideUm);
    for (const Scratch& scratch : surface_models::find_scratches(map, MapAxis::y, kBesideUm)) found.push_back(scratch);
    const auto deepest =
        std::ranges::max_element(found, {}, [](const Scratch& scratch) { return std::abs(scratch.depth_nm); });
    if (deepest == found.end()) break;
    deepest->position_um += kUmPerMm * rest.low_mm[across(deepest->along)];
    rest.marks.push_back(*deepest);
  }
  return rest;
}

void add_waves(FacetResiduals& rest, std::span<const Vec3> left) {
  if (left.empty()) return;
  rest.waves = surface_models::dominant_peaks(laid_out(rest, left));
  std::erase_if(rest.waves, [&](const SpectralPeak& wave) {
    return wave.frequency_per_mm * periods({&rest, wave}) < kMinPeriods;
  });
}

std::vector<FacetWave> common_waves(const std::vector<FacetResiduals>& rests, double feed_mm_per_min) {
  std::vector<std::vector<Found<SpectralPeak>>> groups;
  for (const FacetResiduals& rest : rests)
    for (const SpectralPeak& peak : rest.waves) {
      const Found<SpectralPeak> wave{&rest, peak};
      const auto same = std::ranges::find_if(groups, [&](const auto& group) {
        const SpectralPeak& first = group.front().thing;
        const double most = std::max(kSameFrequency * first.frequency_per_mm,
                                     kSamePeriods / std::min(periods(wave), periods(group.front())));
        return first.axis == peak.axis && std::abs(first.frequency_per_mm - peak.frequency_per_mm) <= most;
      });
      (same != groups.end() ? *same : groups.emplace_back()).push_back(wave);
    }
  std::vector<FacetWave> waves;
  for (const auto& group : groups) waves.push_back(gathered(group, feed_mm_per_min));
  std::ranges::stable_sort(waves, std::ranges::greater(), &FacetWave::amplitude_nm);
  return waves;
}

std::vector<FacetMark> common_marks(const std::vector<FacetResiduals>& rests) {
  std::vector<std::vector<Found<Scratch>>> groups;
  for (const FacetResiduals& rest : rests)
    for (const Scratch& mark : rest.marks) {
      const auto same = std::ranges::find_if(groups, [&](const auto& group) {
        const Scratch& first = group.front().thing;
        return first.along == mark.along && (first.depth_nm > 0.0) == (mark.depth_nm > 0.0) &&
               std::abs(first.position_um - mark.position_um) <= std::max(first.width_um, mark.width_um);
      });
      auto& group = same != groups.end() ? *same : groups.emplace_back();
      if (group.empty() || group.back().rest != &rest) group.push_back({&rest, mark});
    }
  std::vector<FacetMark> marks;
  for (const auto& group : groups) marks.push_back(gathered(group, rests));
  // Remove false marks. They are found next to the mark of a chip on facets whose map shows only a part of this mark.
  const std::vector<FacetMark> all = marks;
  std::erase_if(marks, [&](const FacetMark& mark) {
    return std::ranges::any_of(all, [&](const FacetMark& chip) {
      return chip.is_of_edge && mark.is_along_cut && mark.facets.size() < chip.facets.size() &&
             std::abs(mark.height_nm) < std::abs(chip.height_nm) &&
             std::abs(mark.position_um - chip.position_um) < 2.0 * kBesideUm;
    });
  });
  std::ranges::stable_sort(marks, std::ranges::greater(), [](const FacetMark& m) { return std::abs(m.height_nm); });
  return marks;
}

}  // namespace retrace::studies
