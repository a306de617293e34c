#include "studies/roughness/roughness.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <set>
#include <utility>

#include "core/error.h"
#include "core/number_format.h"
#include "core/task_progress.h"
#include "design/io/design_reader.h"
#include "requests/descriptions.h"
#include "surface_models/scatter/phase.h"

namespace retrace::studies {
namespace {

void check(const design::Design& design) {
  design::require_supported(design, {.what = "retrace roughness", .solids = true, .shells = true});
  if (!design.surface.is_smooth())
    throw InputError(design.where_texture(), "must be left out, because retrace roughness varies the roughness");
  if (design.detector.acceptance_half_angle_deg.size() != 1)
    throw InputError({design.source_name(), 0, "detector.acceptance_half_angle_deg"},
                     fmt::format("must be a single angle for retrace roughness; number of given angles: {}",
                                 design.detector.acceptance_half_angle_deg.size()));
}

/// Returns the design with the facet texture of a point.
/// \param where location for error messages about the texture
design::Design textured(const design::Design& design, const RoughnessPoint& point, double waviness_length_um,
                        const InputLocation& where) {
  design::Design rough = design;
  rough.surface.texture = design::HarveyShackTexture{gaussian_sq_nm(point.roughness_sa_nm), point.correlation_length_um,
                                                     gaussian_sq_nm(point.waviness_sa_nm), waviness_length_um};
  set_where(rough, "surface.model", where);
  return rough;
}

RreSettings direction_of(const RoughnessRequest& asked) {
  RreSettings request;
  request.incidence_deg = {asked.incidence_deg};
  request.azimuth_deg = {asked.azimuth_deg};
  request.seed = asked.seed;
  return request;
}

/// Adds the warnings of a traced point. If several points cause the same kind of warning, only the first is kept.
void add_warnings(RoughnessResult& result, const RreResult& traced) {
  for (const Warning& warning : traced.warnings)
    if (std::ranges::count(result.warnings, warning.id, &Warning::id) == 0) result.warnings.push_back(warning);
  result.rays += traced.rays;
  result.elapsed_s += traced.elapsed_s;
  result.complete = result.complete && traced.complete;
}

}  // namespace

double gaussian_sq_nm(double sa_nm) {
  return sa_nm / surface_models::gaussian_sa(1.0);
}

struct RoughnessStudy::Prepared {
  design::Design design;
  RoughnessRequest request;
  std::vector<FacetGroup> measured;
  std::vector<RoughnessPoint> points;
  std::vector<std::size_t> rough;  ///< indices of the points that are not smooth
  std::unique_ptr<RreStudy> smooth_study;
  std::unique_ptr<RreStudy> rough_study;  ///< study of the rough points, in their order
};

RoughnessStudy::RoughnessStudy(design::Design design, RoughnessRequest request, std::vector<FacetGroup> measured)
    : prepared_(std::make_unique<Prepared>()) {
  check(design);
  requests::check(request);
  Prepared& p = *prepared_;
  std::vector<design::Design> rough;
  const auto add = [&](const RoughnessPoint& point, const InputLocation& where) {
    if (point.roughness_sa_nm > 0.0 || point.waviness_sa_nm > 0.0) {
      p.rough.push_back(p.points.size());
      rough.push_back(textured(design, point, request.waviness_length_um, where));
    }
    p.points.push_back(point);
  };
  for (const double length_um : request.correlation_length_um)
    for (const double sa_nm : request.sa_nm)
      add({sa_nm, 0.0, length_um, {}, 0.0, 0.0},
          {"", 0,
           fmt::format("{} {} {} {}", reference({"sa_nm"}), shortest(sa_nm), reference({"correlation_length_um"}),
                       shortest(length_um))});
  for (std::size_t k = 0; k < measured.size(); ++k) {
    const FacetGroup& group = measured[k];
    add({group.roughness_sa_nm, group.waviness_sa_nm, request.correlation_length_um.front(), k, 0.0, 0.0},
        {group.table, group.line, group.name});
  }
  RreSettings asked = direction_of(request);
  p.smooth_study = std::make_unique<RreStudy>(std::vector{design}, asked);
  asked.rays = request.samples;
  if (!request.samples) asked.target_error = request.target_error;
  if (!rough.empty()) p.rough_study = std::make_unique<RreStudy>(std::move(rough), asked);
  p.design = std::move(design);
  p.request = std::move(request);
  p.measured = std::move(measured);
}

RoughnessStudy::~RoughnessStudy() = default;

namespace {

/// Collects traced points. They may have been traced by other processes.
class RoughnessLedger : public TaskLedger {
 public:
  /// \param at request whose direction of incidence is traced
  /// \param progress may be null
  RoughnessLedger(std::size_t size, const RoughnessRequest& at, Progress* progress)
      : at_(at), progress_(progress), found_(size) {
    for (std::size_t k = 0; k < size; ++k) open_.insert(k);
  }

  std::optional<std::uint64_t> take() override {
    if (open_.empty()) return std::nullopt;
    return open_.extract(open_.begin()).value();
  }
  void give_back(std::uint64_t task) override { open_.insert(task); }
  void finish(std::uint64_t task, const std::string& bytes) override {
    const std::vector<double> numbers = numbers_of(bytes);
    RrePoint& point = found_[task].emplace();
    point.design = task;
    point.incidence_deg = at_.incidence_deg;
    point.azimuth_deg = at_.azimuth_deg;
    point.rre = numbers.at(0);
    point.std_error = numbers.at(1);
    point.ledger[raytrace::Account::truncated] = numbers.at(2);
    point.missed_target = numbers.at(3) != 0.0;
    rays_ += static_cast<std::uint64_t>(numbers.at(4));
    if (progress_ != nullptr) progress_->at(static_cast<double>(++done_) / static_cast<double>(found_.size()));
  }
  bool is_finished() override { return done_ == found_.size(); }

  std::vector<RrePoint> points() const {
    std::vector<RrePoint> points;
    for (const auto& point : found_)
      if (point) points.push_back(*point);
    return points;
  }
  std::uint64_t rays() const { return rays_; }

 private:
  const RoughnessRequest& at_;
  Progress* progress_;
  std::set<std::uint64_t> open_;
  std::vector<std::optional<RrePoint>> found_;
  std::size_t done_ = 0;
  std::uint64_t rays_ = 0;
};

}  // namespace

std::optional<std::string> RoughnessStudy::compute_shared(std::uint64_t number, const Cancellation* cancel) const {
  const RreResult traced = prepared_->rough_study->run_design(number, cancel);
  if (!traced.complete) return std::nullopt;
  const RrePoint& point = traced.points.front();
  return bytes_of({point.rre, point.std_error, point.ledger[raytrace::Account::truncated],
                   point.missed_target ? 1.0 : 0.0, static_cast<double>(traced.rays)});
}

RreResult RoughnessStudy::trace_shared(Progress* progress, const DistributeTasks& distribute) const {
  const auto start = std::chrono::steady_clock::now();
  RoughnessLedger ledger(prepared_->rough.size(), prepared_->request, progress);
  const bool complete = distribute(
      [this](std::uint64_t number, const Cancellation* cancel) { return compute_shared(number, cancel); }, ledger);
  RreResult traced = prepared_->rough_study->result_of(ledger.points());
  traced.complete = complete;
  traced.rays = ledger.rays();
  traced.elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return traced;
}

RoughnessResult RoughnessStudy::run(Progress* progress, const Cancellation* cancel,
                                    const DistributeTasks& distribute) const {
  const Prepared& p = *prepared_;
  RoughnessResult result;
  result.design = p.design;
  result.request = p.request;
  result.measured = p.measured;
  // All points, including the smooth one, are assumed to take equal time.
  const double smooth_share = 1.0 / static_cast<double>(1 + p.rough.size());
  PartProgress smooth_part(progress, 0.0, smooth_share), rough_part(progress, smooth_share, 1.0);
  const RreResult smooth = p.smooth_study->run(&smooth_part, cancel);
  add_warnings(result, smooth);
  if (smooth.points.empty()) return result;
  result.smooth_rre = smooth.points.front().rre;
  result.smooth_std_error = smooth.points.front().std_error;
  RreResult traced;
  if (p.rough_study)
    traced = distribute ? trace_shared(&rough_part, distribute) : p.rough_study->run(&rough_part, cancel);
  add_warnings(result, traced);
  std::vector<const RrePoint*> found(p.points.size(), nullptr);
  for (const RrePoint& point : traced.points) found[p.rough[point.design]] = &point;
  for (std::size_t k = 0; k < p.points.size(); ++k) {
    const bool is_rough = std::binary_search(p.rough.begin(), p.rough.end(), k);
    if (is_rough && found[k] == nullptr) continue;  // the run was interrupted before this point
    RoughnessPoint point = p.points[k];
    point.rre = is_rough ? found[k]->rre : result.smooth_rre;
    point.std_error = is_rough ? found[k]->std_error : result.smooth_std_error;
    result.points.push_back(point);
  }
  return result;
}

}  // namespace retrace::studies
