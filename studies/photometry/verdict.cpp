// Verdicts on readings and on the area of a part. The functions are declared in photometry.h.
#include <algorithm>
#include <cmath>

#include "studies/photometry/photometry.h"

namespace retrace::studies {
namespace {

// Minimum distance of a reading from a limit for a definite verdict, in standard errors.
constexpr double kErrorsOfAMargin = 2.0;

}  // namespace

std::string_view verdict_name(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass: return "pass";
    case Verdict::unconfirmed: return "unconfirmed";
    case Verdict::undetermined: return "undetermined";
    case Verdict::fail: return "fail";
  }
  return {};
}

Verdict PhotometricPoint::verdict() const {
  const bool reaches = r_i_mcd_per_lx >= limit_mcd_per_lx;
  if (is_lower_bound) return reaches ? Verdict::pass : Verdict::undetermined;
  const bool is_too_near = std::abs(r_i_mcd_per_lx - limit_mcd_per_lx) < kErrorsOfAMargin * std_error_mcd_per_lx;
  if (lacks_diffraction || is_too_near) return Verdict::undetermined;
  return reaches ? Verdict::pass : Verdict::fail;
}

Verdict verdict_of(const std::vector<PhotometricPoint>& points, const TestPlan& test_plan) {
  const auto any = [&](Verdict verdict) {
    return std::any_of(points.begin(), points.end(), [&](const PhotometricPoint& p) { return p.verdict() == verdict; });
  };
  for (const Verdict verdict : {Verdict::fail, Verdict::undetermined})
    if (any(verdict)) return verdict;
  const bool is_confirmed = std::none_of(points.begin(), points.end(), [](const PhotometricPoint& p) {
    return p.test_point.status == LimitStatus::recalled;
  });
  return is_confirmed && test_plan.is_complete ? Verdict::pass : Verdict::unconfirmed;
}

Verdict area_verdict(const TestPlan& test_plan, double area_cm2) {
  Verdict verdict = Verdict::pass;
  for (const LimitArea& limit : test_plan.areas) {
    if (!limit.holds(area_cm2)) return Verdict::fail;
    if (limit.status == LimitStatus::recalled) verdict = Verdict::unconfirmed;
  }
  return verdict;
}

}  // namespace retrace::studies
