#include "raytrace/cells/cell_entrance.h"

#include <algorithm>
#include <cmath>

namespace retrace::raytrace {
namespace {

using lanes::Hit, lanes::label_of;

// Maximum distance, divided by the period, by which rounding errors may place a ray outside of its column.
constexpr double kSlack = 1e-12;

}  // namespace

CellEntrance::CellEntrance(const LightSetup& setup, const PathPolicy& policy, const CellArray& array,
                           std::size_t numbers)
    : setup_(setup),
      policy_(policy),
      array_(array),
      height_mm_(setup.thickness_mm - setup.top_mm),
      descending_(numbers),
      exited_(numbers == lanes::kRayComponents ? numbers : lanes::kComponentsOfInfinite),
      queued_{descending_, descending_} {
  if (setup.optics.entrance.scatters()) contaminated_.emplace(setup.optics);
  // The pieces are slightly enlarged to avoid gaps between them due to rounding. A ray just outside of its column
  // crosses into the neighbouring column in its next step.
  const double slack_mm = kSlack * array.period_mm().maxCoeff();
  for (const CellArray::ColumnFragment& piece : array.fragments()) {
    fragment_starts_.push_back(static_cast<std::uint32_t>(fragment_edges_.size()));
    for (const CellArray::Edge& edge : array.columns()[piece.column].edges)
      fragment_edges_.push_back(
          {-edge.normal.x(), -edge.normal.y(), edge.offset_mm - edge.normal.dot(piece.shift_mm) + slack_mm});
  }
  fragment_starts_.push_back(static_cast<std::uint32_t>(fragment_edges_.size()));
}

void CellEntrance::reserve(std::size_t count) {
  descending_.reserve(count);
  if (labels_.size() < count + lanes::kPadding) labels_.resize(2 * count + lanes::kPadding);
}

void CellEntrance::enter(RayStreams& streams, CellRun& run) {
  const auto count = static_cast<double>(descending_.size());
  run.tally.add(setup_.arrival_losses, Account::transmitted, count);
  if (contaminated_) return enter_contaminated(streams, run);
  const LightSetup::Entry& entry = setup_.entry;
  run.tally.entrance_reflected[entry.reflected_cone] += count * entry.reflected;
  run.tally.other[Account::absorbed] += count * entry.absorbed;
  run.tally.add(entry.reflected_losses, Account::returned_elsewhere, count);
  if (setup_.score != nullptr) setup_.score->add(entry.reflected_direction, count * entry.reflected.i, run.tally.score);
  const lanes::Rays rays = descending_.rays();
  for (std::size_t k = 0; k < descending_.size(); ++k) set_ray(rays, k, {entry.direction, entry.light});
  descend(false, streams, run);
}

void CellEntrance::descend(bool scattered, RayStreams& streams, CellRun& run) {
  if (descending_.empty()) return;
  const std::vector<CellArray::ColumnFragment>& pieces = array_.fragments();
  const lanes::Rays rays = descending_.rays();
  const std::size_t count = streams.keep_inner(rays, descending_.size(), -height_mm_, true, scattered);
  run.tally.other[Account::absorbed] +=
      lanes::descend(rays, count, height_mm_, setup_.top_mm, array_.period_mm(), setup_.optics.absorption_per_mm);
  if (pieces.size() > 1)
    lanes::mark_polygon(rays, count, fragment_edges_, fragment_starts_, labels_.data());
  else
    std::fill_n(labels_.begin(), count, 0);
  std::size_t left = count;
  for (std::size_t k = 0; k < pieces.size() && left > 0; ++k) {
    const StreamKey stream{pieces[k].column, RayLocation::inside, scattered};
    const lanes::Rays to = streams.end_of(stream, left);
    const std::size_t more = lanes::select(labels_.data(), static_cast<lanes::Label>(k), count, rays, to);
    if (pieces[k].shift_mm != Vec2::Zero()) lanes::shift(to, more, pieces[k].shift_mm);
    streams.grow(stream, more);
    left -= more;
  }
  // The pieces together cover the period. Every ray should therefore be in one of them. A ray outside of all pieces is
  // counted as lost.
  run.tally.misses += left;
  run.tally.other[Account::lost] += static_cast<double>(left);
}

void CellEntrance::meet(const CellStep& step) {
  // Rays that would reach a side of the part before the entrance face are added to RayStreams::handed_over().
  const lanes::BoundsTest outline{height_mm_, step.run.outline_mm.lower, step.run.outline_mm.upper};
  if (array_.inner() && lanes::mark_beyond(step.rays(), step.size(), outline, label_of(Hit::end), label_of(Hit::limit),
                                           step.batch.hits.labels()) > 0)
    step.streams.hand_over(step.rays(), step.size(), step.batch.hits.labels(), label_of(Hit::limit), true,
                           step.stream().scattered);
  if (contaminated_) return meet_contaminated(step);
  if (!setup_.optics.has_bare_entrance() || affect_light(setup_.optics.shells)) return meet_layers(step);
  meet_bare(step);
}

void CellEntrance::meet_bare(const CellStep& step) {
  const Optics& optics = setup_.optics;
  CellRun& run = step.run;
  const bool scattered = step.stream().scattered;
  const lanes::Entrance entrance = {
      height_mm_,       optics.index,      optics.absorption_per_mm, optics.lossless_entrance,
      setup_.to_source, setup_.cone_chord2};
  const bool is_kept = setup_.score != nullptr || run.observer != nullptr;
  if (is_kept) exited_.reserve(step.size());
  const lanes::Rays left = exited_.rays();
  const lanes::Arrivals arrivals =
      lanes::meet_entrance(step.rays(), step.size(), step.meeting(label_of(Hit::end)), entrance, descending_.rays(),
                           scattered ? run.tally.scattered : run.tally.returned, is_kept ? &left : nullptr);
  for (std::size_t k = 0; k < arrivals.exited; ++k) {
    const Vec3 direction = vector_of(left, lanes::kDx, k);
    if (setup_.score != nullptr) setup_.score->add(direction, left[lanes::kI][k], run.tally.score);
    if (run.observer != nullptr)
      run.observer->on_exit(owner_of(left, k), position_of(left, k), direction, left[lanes::kI][k]);
  }
  run.tally.segments += arrivals.count;
  run.tally.other[Account::absorbed] += arrivals.absorbed;
  descending_.resize(arrivals.reflected);
  descend(scattered, step.streams, run);
}

// The following functions process rays one by one. They are used if the entrance face has layers or scatters light, or
// if there are shells. Their computations are so expensive that SIMD would save little time.

/// Returns ray k at the entrance face. The power that the material absorbs on the path to the face is added to the
/// ledger.
Ray CellEntrance::risen(const CellStep& step, const lanes::Rays& rays, std::size_t k) const {
  ++step.run.tally.segments;
  Ray ray = step.batch.ray(rays, k);
  const double before = ray.light.power();
  ray.light.scale(std::exp(-setup_.optics.absorption_per_mm * (height_mm_ / ray.direction.z())));
  step.run.tally.other[Account::absorbed] += before - ray.light.power();
  return ray;
}

void CellEntrance::meet_layers(const CellStep& step) {
  const Optics& optics = setup_.optics;
  CellRun& run = step.run;
  const bool scattered = step.stream().scattered;
  const Vec3 down = -Vec3::UnitZ();
  const lanes::Rays rays = step.rays();
  const lanes::Rays falling = descending_.rays();
  std::vector<Stokes>& returned = scattered ? run.tally.scattered : run.tally.returned;
  std::size_t reflected_count = 0;
  for (std::size_t k = 0; k < step.size(); ++k) {
    if (step.batch.hits.labels()[k] != label_of(Hit::end)) continue;
    Ray ray = risen(step, rays, k);
    const double way_mm = height_mm_ / ray.direction.z();
    const double cos_incidence = ray.direction.z();
    const materials::FresnelCoefficients f = fresnel_at_entrance(optics, true, cos_incidence);
    ray.light.rotate_basis_to_interface(ray.direction, down);
    Light reflected = ray.light.reflected(f);
    Light transmitted = ray.light.transmitted(f);
    run.tally.other[Account::absorbed] += absorbed_at_entrance(optics, ray.light, reflected, transmitted);
    const Branch branch = choose_branch(reflected, transmitted, policy_.split_power, [&] { return run.random(); });
    if (branch != Branch::reflected) {
      const Vec3 out = refracted(ray.direction, down, optics.index, cos_incidence, f.cos_refracted);
      run.tally.add(setup_.pass_shells_outward(transmitted, out), Account::returned_elsewhere);
      returned[setup_.cone_of(out)] += in_source_axes(transmitted, out);
      if (setup_.score != nullptr) setup_.score->add(out, transmitted.power(), run.tally.score);
      if (run.observer != nullptr)
        run.observer->on_exit(owner_of(rays, k), position_of(rays, k) + way_mm * ray.direction, out,
                              transmitted.power());
    }
    if (branch == Branch::transmitted) continue;
    copy_ray(rays, k, falling, reflected_count, {mirrored(ray.direction, down), reflected, true, scattered});
    falling[lanes::kX][reflected_count] += way_mm * ray.direction.x();
    falling[lanes::kY][reflected_count] += way_mm * ray.direction.y();
    falling[lanes::kZ][reflected_count] = setup_.thickness_mm;
    ++reflected_count;
  }
  descending_.resize(reflected_count);
  descend(scattered, step.streams, run);
}

/// Returns the rays, inside and outside the part, into which a scattering face splits the incident ray.
const EntranceScatter& CellEntrance::scatter_at_face(const Ray& ray, CellRun& run) {
  surface_models::RandomStream random = run.random_stream();
  scatter_.clear();
  contaminated_->meet(ray, policy_.split_power, random, scatter_);
  run.tally.other[Account::absorbed] += scatter_.absorbed;
  run.tally.other[Account::truncated] += scatter_.truncated;
  return scatter_;
}

void CellEntrance::enter_contaminated(RayStreams& streams, CellRun& run) {
  const lanes::Rays rays = descending_.rays();
  for (std::size_t k = 0; k < descending_.size(); ++k) {
    const Vec3 position(rays[lanes::kX][k], rays[lanes::kY][k], setup_.thickness_mm);
    for (const Ray& ray : scatter_at_face({-setup_.to_source, setup_.incident, false, false}, run).rays) {
      if (ray.inside)
        queue(rays, k, position, ray);
      else
        add_entrance_reflection(setup_, ray, run.tally);
    }
  }
  descend_queued(streams, run);
}

void CellEntrance::meet_contaminated(const CellStep& step) {
  Tally& tally = step.run.tally;
  const lanes::Rays rays = step.rays();
  for (std::size_t k = 0; k < step.size(); ++k) {
    if (step.batch.hits.labels()[k] != label_of(Hit::end)) continue;
    const Ray met = risen(step, rays, k);
    const double way_mm = height_mm_ / met.direction.z();
    const Vec3 position(rays[lanes::kX][k] + way_mm * met.direction.x(),
                        rays[lanes::kY][k] + way_mm * met.direction.y(), setup_.thickness_mm);
    for (const Ray& ray : scatter_at_face(met, step.run).rays) {
      if (ray.inside) {
        queue(rays, k, position, ray);
        continue;
      }
      Light light = ray.light;
      tally.add(setup_.pass_shells_outward(light, ray.direction), Account::returned_elsewhere);
      (ray.scattered ? tally.scattered : tally.returned)[setup_.cone_of(ray.direction)] +=
          in_source_axes(light, ray.direction);
      if (setup_.score != nullptr) setup_.score->add(ray.direction, light.power(), tally.score);
    }
  }
  descend_queued(step.streams, step.run);
}

/// Queues a ray that starts just below the face. Values that `position` and `ray` do not contain, such as the owner,
/// are copied from ray `k` of `from`.
void CellEntrance::queue(const lanes::Rays& from, std::size_t k, const Vec3& position, const Ray& ray) {
  RayStore& to = queued_[ray.scattered ? 1 : 0];
  to.reserve(to.size() + 1);
  const lanes::Rays end = to.rays(to.size());
  copy_ray(from, k, end, 0, ray);
  for (std::size_t n = 0; n < 3; ++n) end[lanes::kX + n][0] = position[static_cast<Eigen::Index>(n)];
  to.resize(to.size() + 1);
}

/// Moves the queued rays down to the top of the back surface, in groups that fit into the reserved memory.
void CellEntrance::descend_queued(RayStreams& streams, CellRun& run) {
  const std::size_t most = labels_.size() - lanes::kPadding;
  descending_.reserve(most);
  for (const bool scattered : {false, true}) {
    RayStore& from = queued_[scattered ? 1 : 0];
    for (std::size_t first = 0; first < from.size(); first += most) {
      const std::size_t count = std::min(most, from.size() - first);
      descending_.resize(count);
      const lanes::Rays rays = from.rays(first);
      const lanes::Rays falling = descending_.rays();
      for (std::size_t n = 0; n < rays.component_count; ++n) std::copy_n(rays[n], count, falling[n]);
      descend(scattered, streams, run);
    }
    from.clear();
  }
}

}  // namespace retrace::raytrace
