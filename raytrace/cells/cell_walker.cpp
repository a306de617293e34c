#include "raytrace/cells/cell_walker.h"

#include <algorithm>
#include <optional>

#include "raytrace/cells/cell_facets.h"

namespace retrace::raytrace {
namespace {

using lanes::Hit, lanes::label_of;

std::size_t numbers_of(const CellArray& array, bool has_owners) {
  if (has_owners) return lanes::kRayComponents;
  return array.inner() ? lanes::kComponentsOfFinite : lanes::kComponentsOfInfinite;
}

/// Returns the inner region of a finite part, relative to the centre of its entrance face.
std::optional<geometry::Rectangle> inner_of(const CellArray& array, const Vec2& centre_mm) {
  if (!array.inner()) return std::nullopt;
  const geometry::Rectangle& inner = array.inner()->where_mm;
  return geometry::Rectangle{inner.lower - centre_mm, inner.upper - centre_mm};
}

/// Moves the rays that cross a border into the stream of the neighbouring column.
void cross(const ColumnFaces::Exit& exit, const CellStep& step) {
  const RayLocation place = step.stream().inside() ? RayLocation::inside : RayLocation::below;
  const StreamKey to{exit.column, place, step.stream().scattered};
  const std::size_t more = lanes::select(step.batch.hits.labels(), exit.crossing, step.size(), step.rays(),
                                         step.streams.end_of(to, step.size()));
  step.streams.grow_from_neighbour(to, more, exit.shift_mm);
}

/// Ends the rays that have left the part through its back and meet no further face.
void leave_through_back(const CellStep& step) {
  step.add_to_ledger(label_of(Hit::end), Account::transmitted);
  if (step.run.observer == nullptr) return;
  const lanes::Rays rays = step.rays();
  for (std::size_t k = 0; k < step.size(); ++k)
    if (step.batch.hits.labels()[k] == label_of(Hit::end))
      step.run.observer->on_transmission(owner_of(rays, k), rays[lanes::kI][k]);
}

}  // namespace

CellWalker::CellWalker(const LightSetup& setup, const PathPolicy& policy, const CellArray& array, const Vec2& centre_mm,
                       bool has_owners)
    : setup_(setup),
      policy_(policy),
      array_(array),
      anchor_mm_(-centre_mm),
      faces_(array),
      streams_(array.columns().size(), numbers_of(array, has_owners), inner_of(array, centre_mm)),
      entrance_(setup, policy, array, numbers_of(array, has_owners)),
      batch_{{}, RayStore(numbers_of(array, has_owners)), {}} {
  if (array.inner()) anchor_mm_ += array.inner()->anchor_mm;
}

void CellWalker::trace(const geometry::Rectangle& entrance_mm, std::uint64_t key_x, std::uint64_t key_y,
                       std::uint32_t first, std::size_t count, RandomKey key, std::uint32_t replicate, Tally& tally) {
  CellRun run{tally, nullptr, entrance_mm, key, replicate, first};
  begin(count);
  const lanes::Rays rays = entrance_.rays().rays();
  lanes::sobol(key_x, key_y, first, count, entrance_mm.size(), rays[lanes::kX], rays[lanes::kY]);
  std::fill_n(rays[lanes::kZ], count, setup_.thickness_mm);
  if (array_.inner()) {
    std::fill_n(rays[lanes::kOx], count, entrance_mm.lower.x());
    std::fill_n(rays[lanes::kOy], count, entrance_mm.lower.y());
    lanes::shift(rays, count, entrance_mm.lower - anchor_mm_);
  }
  entrance_.enter(streams_, run);
  advance_all(run);
}

void CellWalker::follow(const std::vector<CellRay>& starts, const geometry::Rectangle& entrance_mm, RandomKey key,
                        std::uint32_t replicate, std::uint32_t first, Tally& tally, CellObserver& observer) {
  CellRun run{tally, &observer, entrance_mm, key, replicate, first};
  begin(starts.size());
  const lanes::Rays rays = entrance_.rays().rays();
  for (std::size_t k = 0; k < starts.size(); ++k) {
    for (std::size_t n = 0; n < 3; ++n) rays[lanes::kX + n][k] = starts[k].position[static_cast<Eigen::Index>(n)];
    set_ray(rays, k, starts[k].ray);
    rays[lanes::kOx][k] = rays[lanes::kOy][k] = 0.0;
    rays[lanes::kOwner][k] = static_cast<double>(starts[k].owner);
  }
  lanes::shift(rays, starts.size(), -anchor_mm_);
  entrance_.descend(false, streams_, run);
  advance_all(run);
}

void CellWalker::reserve(std::size_t count) {
  batch_.rays.reserve(count);
  batch_.hits.reserve(count);
  entrance_.reserve(count);
}

void CellWalker::begin(std::size_t count) {
  streams_.clear_handed_over();
  reserve(count);
  entrance_.rays().resize(count);
}

/// Moves all rays until no ray remains. A step moves each ray at most one time. The number of interfaces on a path is
/// therefore not greater than the number of steps, to which the limit `max_events` is applied.
void CellWalker::advance_all(CellRun& run) {
  std::uint64_t steps = 0;
  while (const std::optional<StreamKey> stream = streams_.take_fullest(batch_.rays)) {
    batch_.stream = *stream;
    reserve(batch_.rays.size());
    truncate_weak(run.tally);
    if (++steps > policy_.max_events)
      run.tally.other[Account::truncated] += lanes::sum(batch_.rays.rays(), batch_.rays.size());
    else
      advance(run);
  }
  choices_ = run.choices;
}

/// Moves the rays of the present batch to the next face and processes them there.
void CellWalker::advance(CellRun& run) {
  run.tally.other[Account::absorbed] += faces_.advance(setup_, batch_);
  const CellStep step{setup_, policy_, faces_, batch_, streams_, run};
  meet_facets(step);
  if (batch_.stream.inside())
    entrance_.meet(step);
  else
    leave_through_back(step);
  for (const ColumnFaces::Exit& exit : faces_.exits(batch_.stream)) {
    cross(exit, step);
    if (exit.wall) meet_wall(exit, step);
  }
}

/// Ends the rays of the present batch with less power than the cut-off.
void CellWalker::truncate_weak(Tally& tally) {
  const lanes::Rays rays = batch_.rays.rays();
  lanes::Label* labels = batch_.hits.labels();
  if (lanes::mark_weak(rays, policy_.cutoff, batch_.rays.size(), labels) == 0) return;
  const double before = lanes::sum(rays, batch_.rays.size());
  batch_.rays.resize(lanes::select(labels, lanes::kKept, batch_.rays.size(), rays, rays));
  tally.other[Account::truncated] += before - lanes::sum(rays, batch_.rays.size());
}

}  // namespace retrace::raytrace
