#include "studies/roughness/roughness.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/number_format.h"
#include "studies/rre/rre.h"
#include "surface_models/scatter/phase.h"

namespace retrace::studies {
namespace {

constexpr double kMostSaNm = 1e5;
constexpr double kMostLengthUm = 1e6;

void check(const std::vector<double>& values, double most, bool zero_allowed, const char* option) {
  for (const double value : values)
    if (!(value <= most && (value > 0.0 || (zero_allowed && value == 0.0))))
      throw InputError({"", 0, option}, fmt::format("must be {} 0 and <= {}, got {}", zero_allowed ? ">=" : ">",
                                                    shortest(most), shortest(value)));
}

void check(const Design& design) {
  check_taken(design, {.what = "retrace roughness", .solids = true});
  if (!design.surface.is_smooth())
    throw InputError(design.where_texture(), "must be left out here: the roughness is what is varied");
  if (design.detector.acceptance_half_angle_deg.size() != 1)
    throw InputError({design.source_name(), 0, "detector.acceptance_half_angle_deg"},
                     fmt::format("must be one angle here, got {}", design.detector.acceptance_half_angle_deg.size()));
}

/// The design with that texture. \param where to blame for it
Design textured(const Design& design, const RoughnessPoint& point, double waviness_length_um,
                const InputLocation& where) {
  Design rough = design;
  rough.surface.texture = HarveyShackTexture{gaussian_sq_nm(point.roughness_sa_nm), point.correlation_length_um,
                                             gaussian_sq_nm(point.waviness_sa_nm), waviness_length_um};
  rough.set_where("surface.model", where);
  return rough;
}

RreRequest direction_of(const RoughnessRequest& asked) {
  RreRequest request;
  request.incidence_deg = {asked.incidence_deg};
  request.azimuth_deg = {asked.azimuth_deg};
  request.seed = asked.seed;
  return request;
}

/// Points of a curve leave the range of a model one after the other: one warning of each kind is enough.
std::string without_numbers(std::string warning) {
  std::erase_if(warning, [](char c) { return (c >= '0' && c <= '9') || c == '.'; });
  return warning;
}

void add_warnings(RoughnessResult& result, const RreResult& traced) {
  for (const std::string& warning : traced.warnings) {
    const auto says_the_same = [&](const std::string& other) {
      return without_numbers(other) == without_numbers(warning);
    };
    if (std::none_of(result.warnings.begin(), result.warnings.end(), says_the_same)) result.warnings.push_back(warning);
  }
  result.rays += traced.rays;
  result.elapsed_s += traced.elapsed_s;
  result.complete = result.complete && traced.complete;
}

}  // namespace

double gaussian_sq_nm(double sa_nm) {
  return sa_nm / surface_models::gaussian_sa(1.0);
}

struct RoughnessStudy::Prepared {
  Design design;
  RoughnessRequest request;
  std::vector<RoughnessPoint> points;
  std::vector<std::size_t> rough;  ///< which of them are not smooth
  std::unique_ptr<RreStudy> smooth_study;
  std::unique_ptr<RreStudy> rough_study;  ///< of those, in their order
};

RoughnessStudy::RoughnessStudy(Design design, RoughnessRequest request) : prepared_(std::make_unique<Prepared>()) {
  check(design);
  check(request.sa_nm, kMostSaNm, true, "--sa");
  check(request.correlation_length_um, kMostLengthUm, false, "--correlation-length-um");
  check({request.waviness_length_um}, kMostLengthUm, false, "--waviness-length-um");
  Prepared& p = *prepared_;
  std::vector<Design> rough;
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
          {"", 0, fmt::format("--sa {} --correlation-length-um {}", shortest(sa_nm), shortest(length_um))});
  for (std::size_t k = 0; k < request.measured.size(); ++k) {
    const FacetGroup& group = request.measured[k];
    add({group.roughness_sa_nm, group.waviness_sa_nm, request.correlation_length_um.front(), k, 0.0, 0.0},
        {group.table, group.line, group.name});
  }
  RreRequest asked = direction_of(request);
  p.smooth_study = std::make_unique<RreStudy>(std::vector{design}, asked);
  asked.target_error = request.target_error;
  asked.rays = request.rays;
  if (!rough.empty()) p.rough_study = std::make_unique<RreStudy>(std::move(rough), asked);
  p.design = std::move(design);
  p.request = std::move(request);
}

RoughnessStudy::~RoughnessStudy() = default;

RoughnessResult RoughnessStudy::run(Progress* progress, const Cancellation* cancel) const {
  const Prepared& p = *prepared_;
  RoughnessResult result;
  result.design = p.design;
  result.request = p.request;
  const RreResult smooth = p.smooth_study->run(nullptr, cancel);
  add_warnings(result, smooth);
  if (smooth.points.empty()) return result;
  result.smooth_rre = smooth.points.front().rre;
  result.smooth_std_error = smooth.points.front().std_error;
  RreResult traced;
  if (p.rough_study) traced = p.rough_study->run(progress, cancel);
  add_warnings(result, traced);
  std::vector<const RrePoint*> found(p.points.size(), nullptr);
  for (const RrePoint& point : traced.points) found[p.rough[point.design]] = &point;
  for (std::size_t k = 0; k < p.points.size(); ++k) {
    const bool is_rough = std::binary_search(p.rough.begin(), p.rough.end(), k);
    if (is_rough && found[k] == nullptr) continue;  // interrupted before
    RoughnessPoint point = p.points[k];
    point.rre = is_rough ? found[k]->rre : result.smooth_rre;
    point.std_error = is_rough ? found[k]->std_error : result.smooth_std_error;
    result.points.push_back(point);
  }
  return result;
}

}  // namespace retrace::studies
