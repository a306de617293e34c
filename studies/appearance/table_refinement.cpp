#include "studies/appearance/table_refinement.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <span>

#include "core/random.h"
#include "core/threads.h"
#include "geometry/direction.h"
#include "studies/appearance/table_errors.h"
#include "studies/appearance/view_grid.h"

namespace retrace::studies {
namespace {

using geometry::Vec3;

// Threshold for halving a cell along a side. For each of the two sides, the mean third difference of the values is
// computed. A cell is halved along a side if its third difference is at least this fraction of the larger of the two,
// or if the other side cannot be halved.
constexpr double kMinDifferenceRatio = 0.3;
// Number of directions of light that are computed in parallel.
constexpr std::size_t kBatch = 16;
// Number of random view directions at which the error of a cell is measured, for each tested direction of light.
constexpr std::uint32_t kViews = 48;
constexpr RandomKey kViewKey{.seed = kAppearanceSeed, .stream = 1};

/// Adds directions of light to a table.
class DirectionList {
 public:
  /// \param most maximum number of directions, from which the progress is estimated
  DirectionList(const ColourPhotometer& photometer, const LightLattice& lattice, std::size_t most,
                ReflectionTable& table)
      : photometer_(photometer), lattice_(lattice), max_directions_(most), table_(table) {}

  /// Returns the lattice positions of those directions of the cells that have not been computed yet.
  std::vector<LatticeIndex> missing(const std::vector<PlannedCell>& cells) const {
    std::vector<LatticeIndex> places;
    for (const PlannedCell& cell : cells)
      for (const LatticeIndex& place : lattice_.indices_of(cell))
        if (!known_.contains(place) && std::find(places.begin(), places.end(), place) == places.end())
          places.push_back(place);
    return places;
  }

  /// Computes those directions of the cells that have not been computed yet. The first call must pass the cells from
  /// which refinement starts. Returns false if the computation was cancelled.
  bool add(const std::vector<PlannedCell>& cells, Progress* progress, const Cancellation* cancel) {
    const std::vector<LatticeIndex> places = missing(cells);
    for (std::size_t first = 0; first < places.size(); first += kBatch) {
      const std::size_t count = std::min(kBatch, places.size() - first);
      if (!compute({places.data() + first, count}, cancel)) return false;
      if (progress != nullptr) progress->at(fraction_done(places.size()));
    }
    if (first_count_ == 0) first_count_ = table_.directions.size();
    return true;
  }

  /// Converts a planned cell to a cell of the table.
  /// \pre the directions of the cell have been computed
  ReflectionTable::Cell cell_of(const PlannedCell& planned) const {
    ReflectionTable::Cell cell;
    cell.entrance = {lattice_.entrance_at(planned.corner[0]),
                     lattice_.entrance_at(planned.corner[0] + planned.size[0])};
    cell.azimuth = {lattice_.azimuth_at(planned.corner[1]), lattice_.azimuth_at(planned.corner[1] + planned.size[1])};
    const std::vector<LatticeIndex> places = lattice_.indices_of(planned);
    for (std::size_t k = 0; k < places.size(); ++k) cell.directions[k] = known_.at(places[k]);
    return cell;
  }

 private:
  bool compute(std::span<const LatticeIndex> places, const Cancellation* cancel) {
    std::vector<ReflectionTable::Direction> computed(places.size());
    for_each_in_parallel(places.size(), [&](std::size_t k) {
      computed[k] = {lattice_.entrance_at(places[k].first), lattice_.azimuth_at(places[k].second), {}};
      const Vec3 to_source = geometry::direction_at(computed[k].entrance, computed[k].azimuth);
      if (const std::optional<ColourFields> fields = photometer_.fields(to_source, cancel))
        computed[k].r_a = grid_of(table_, to_source, *fields, photometer_.eye().kernel(), cancel);
    });
    if (is_cancelled(cancel)) return false;
    for (std::size_t k = 0; k < places.size(); ++k) {
      known_[places[k]] = table_.directions.size();
      table_.directions.push_back(std::move(computed[k]));
    }
    return true;
  }

  /// Returns the finished fraction of the work. The first cells count as one half of the work, because the amount of
  /// refinement after them is not known in advance.
  /// \param first number of directions of the first cells; used only while these directions are computed
  double fraction_done(std::size_t first) const {
    const auto done = static_cast<double>(table_.directions.size());
    if (first_count_ == 0) return 0.5 * done / static_cast<double>(first);
    const auto before = static_cast<double>(first_count_);
    return 0.5 + 0.5 * (done - before) / std::max(static_cast<double>(max_directions_) - before, done - before);
  }

  const ColourPhotometer& photometer_;
  const LightLattice& lattice_;
  std::size_t max_directions_;
  ReflectionTable& table_;
  std::map<LatticeIndex, std::size_t> known_;  ///< index of each lattice position in the table's list of directions
  std::size_t first_count_ = 0;                ///< number of directions of the first cells; 0 until they are computed
};

/// Returns the mean third differences of the values of a cell along entrance angle and azimuth.
std::array<double, 2> bends_of(const ReflectionTable& table, const ReflectionTable::Cell& cell) {
  const auto value = [&](std::size_t azimuth, std::size_t entrance, std::size_t point) {
    return luminous(table.directions[cell.directions[kDirectionsPerSide * azimuth + entrance]].r_a[point]);
  };
  std::array<double, 2> bends{};
  for (std::size_t point = 0; point < table.columns * table.columns; ++point)
    for (std::size_t line = 0; line < kDirectionsPerSide; ++line) {
      bends[0] += std::abs(value(line, 3, point) - 3.0 * value(line, 2, point) + 3.0 * value(line, 1, point) -
                           value(line, 0, point));
      bends[1] += std::abs(value(3, line, point) - 3.0 * value(2, line, point) + 3.0 * value(1, line, point) -
                           value(0, line, point));
    }
  return bends;
}

/// Returns the smaller cells into which a cell is divided. The cell is halved along each side along which the third
/// differences of the values are large (see kMinDifferenceRatio).
std::vector<PlannedCell> halves_of(const PlannedCell& cell, const std::array<double, 2>& bends) {
  const double most = std::max(bends[0], bends[1]);
  std::vector<PlannedCell> parts = {cell};
  for (const std::size_t side : {0U, 1U}) {
    if (cell.size[side] <= 3) continue;
    if (cell.size[1 - side] > 3 && bends[side] < kMinDifferenceRatio * most) continue;
    const std::size_t count = parts.size();
    for (std::size_t k = 0; k < count; ++k) {
      parts[k].size[side] /= 2;
      parts.push_back(parts[k]);
      parts.back().corner[side] += parts[k].size[side];
    }
  }
  return parts;
}

/// Returns the priority with which a cell is halved. It is proportional to the error of the cell times its projected
/// solid angle of light directions. Returns 0 if the error is small enough or the cell cannot be halved further.
double urgency(const LightLattice& lattice, const PlannedCell& cell, double requested_error) {
  if (cell.error <= requested_error || cell.is_smallest()) return 0.0;
  const double from = std::sin(lattice.entrance_at(cell.corner[0]).rad());
  const double to = std::sin(lattice.entrance_at(cell.corner[0] + cell.size[0]).rad());
  return cell.error * (to * to - from * from) * cell.size[1];
}

/// Compares the table with the photometer at random geometries inside the cells from index `first` on, and sets the
/// errors of these cells. Returns false if the computation was cancelled.
bool measure_errors(const ReflectionTable& table, const LightLattice& lattice, const Photometer& eye, std::size_t first,
                    std::vector<PlannedCell>& cells, const Cancellation* cancel) {
  std::vector<PhotometerSetting> settings;
  std::vector<double> told;
  std::vector<double> most;
  std::vector<std::size_t> of_cell;
  for (std::size_t k = first; k < cells.size(); ++k) {
    for (const double share : {1.0 / 6.0, 0.5, 5.0 / 6.0}) {
      const Vec3 to_source = lattice.to_source(cells[k], share, share);
      const double greatest = max_r_a(table, to_source);
      for (std::uint32_t view = 0; view < kViews; ++view) {
        const auto random = philox(kViewKey, view, static_cast<std::uint32_t>(k));
        const auto seen = view_at(table, to_source, random_deviation(table, random[0], random[1]));
        if (!seen) continue;
        settings.push_back(setting_of(*seen));
        told.push_back(luminous(table.r_a(seen->to_source, seen->to_observer).value()));
        most.push_back(greatest);
        of_cell.push_back(k);
      }
    }
  }
  const auto readings = eye.measure(settings, nullptr, cancel);
  if (!readings) return false;
  std::map<std::size_t, std::vector<double>> errors;
  for (std::size_t k = 0; k < settings.size(); ++k)
    errors[of_cell[k]].push_back(error_of(told[k], (*readings)[k].r_a.front(), most[k]));
  for (auto& [cell, of_views] : errors) cells[cell].error = percentile_95_of(of_views);
  return true;
}

}  // namespace

bool refine_cells(const MaterialRequest& request, const ColourPhotometer& photometer, const LightLattice& lattice,
                  ReflectionTable& table, std::vector<PlannedCell>& cells, Progress* progress,
                  const Cancellation* cancel) {
  DirectionList directions(photometer, lattice, request.max_directions, table);
  cells = lattice.first_cells();
  if (!directions.add(cells, progress, cancel)) return false;
  for (std::size_t measured = 0;;) {
    table.cells.clear();
    for (const PlannedCell& cell : cells) table.cells.push_back(directions.cell_of(cell));
    if (!measure_errors(table, lattice, photometer.eye(), measured, cells, cancel)) return false;
    const auto urgency_of = [&](const PlannedCell& cell) { return urgency(lattice, cell, request.error); };
    const auto worst = std::max_element(cells.begin(), cells.end(), [&](const PlannedCell& a, const PlannedCell& b) {
      return urgency_of(a) < urgency_of(b);
    });
    if (!(urgency_of(*worst) > 0.0)) return true;
    const std::vector<PlannedCell> parts = halves_of(*worst, bends_of(table, directions.cell_of(*worst)));
    if (directions.missing(parts).size() + table.directions.size() > request.max_directions) return true;
    if (!directions.add(parts, progress, cancel)) return false;
    cells.erase(worst);
    measured = cells.size();
    cells.insert(cells.end(), parts.begin(), parts.end());
  }
}

}  // namespace retrace::studies
