#include "retrace/study.h"

#include <chrono>
#include <memory>
#include <utility>

#include "core/threads.h"
#include "design/io/design_reader.h"
#include "library/drawing_content.h"
#include "report/results/result_plots.h"
#include "requests/descriptions.h"
#include "studies/optimise/io/optimise_reader.h"
#include "studies/optimise/io/optimum_files.h"
#include "studies/quantity/io/study_reader.h"
#include "studies/quantity/machining_limits.h"
#include "studies/sweep/io/sweep_files.h"
#include "studies/sweep/io/sweep_reader.h"
#include "studies/tolerance/io/tolerance_files.h"
#include "studies/tolerance/io/tolerance_reader.h"

namespace retrace {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

studies::Study to_study(const Study& study, const StudyRequest& request) {
  requests::check(request);
  return studies::parse_study(study.text, study.source, request.overrides, request.seed, study.designs);
}

/// Returns the action to take if the store of the study already exists.
/// \pre requests::check() has accepted the request
compute::IfExists if_exists_of(const StudyRequest& request) {
  if (request.if_exists == "resume") return compute::IfExists::resume;
  return request.if_exists == "overwrite" ? compute::IfExists::overwrite : compute::IfExists::refuse;
}

/// Reports the progress of a sweep to a Progress object. A value that is smaller than an earlier one is not reported.
class Share : public studies::SweepObserver {
 public:
  explicit Share(Progress* progress) : progress_(progress) {}
  void at(std::uint64_t done, std::uint64_t total, std::uint64_t) override {
    at_fraction(total > 0 ? static_cast<double>(done) / static_cast<double>(total) : 1.0);
  }
  void at_fraction(double share) override {
    if (progress_ == nullptr || share < reported_) return;
    reported_ = share;
    progress_->at(share);
  }

 private:
  Progress* progress_;
  double reported_ = 0.0;
};

/// Owns a sweep. Results of the sweep refer to it, so this object must exist as long as they are used.
struct Swept {
  explicit Swept(studies::Sweep of) : sweep(std::move(of)) {}
  studies::Sweep sweep;
};

/// Computes the points that are not in the store and returns all results.
/// \param held sweep; it must exist as long as the result is used
studies::SweepResult carried_out(Swept& held, const StudyRequest& request, const Running& running) {
  const Clock::time_point start = Clock::now();
  compute::ResultStore store(request.store, held.sweep.layout(), if_exists_of(request));
  Share share(running.progress);
  bool complete = false;
  run_with_threads(running.threads,
                   [&] { complete = studies::run_sweep(held.sweep, store, &share, running.cancellation); });
  studies::SweepResult result = studies::collect(held.sweep, store, complete);
  result.elapsed_s = seconds_since(start);
  return result;
}

}  // namespace

Study Study::load(const std::filesystem::path& file) {
  return {design::read_toml_text(file), file == "-" ? "standard input" : file.string(), {}};
}

StudyResult sweep(const Study& study, const StudyRequest& request, const Running& running) {
  Swept held(studies::read_sweep(to_study(study, request)));
  const studies::SweepResult found = carried_out(held, request, running);
  StudyResult result;
  result.complete = found.complete;
  result.warnings = found.warnings;
  result.json = studies::sweep_json(found);
  result.csv = studies::sweep_csv(found);
  result.table = studies::sweep_table(found);
  return result;
}

StudyResult tolerance(const Study& study, const StudyRequest& request, const Running& running) {
  studies::Study of_study = to_study(study, request);
  const studies::ToleranceRequest asked = studies::read_tolerance(of_study);
  const auto held = std::make_shared<Swept>(studies::tolerance_sweep(std::move(of_study), asked));
  studies::SweepResult swept = carried_out(*held, request, running);
  const auto found =
      std::make_shared<const studies::ToleranceResult>(studies::analyse(held->sweep, asked, swept.points));
  append(swept.warnings, found->warnings);
  StudyResult result;
  result.complete = swept.complete;
  result.is_yes = found->is_enough;
  result.warnings = swept.warnings;
  result.json = studies::tolerance_json(swept, asked, *found);
  result.csv = studies::sweep_csv(swept);
  result.table = studies::tolerance_text(held->sweep.study(), asked, *found);
  result.drawing =
      drawing_of([held, asked, found] { return report::tolerance_plot(held->sweep.study(), asked, *found); });
  return result;
}

StudyResult optimize(const Study& study, const StudyRequest& request, const Running& running) {
  const Clock::time_point start = Clock::now();
  const studies::Study of_study = studies::with_machining_limits(to_study(study, request));
  const studies::OptimiseRequest asked = studies::read_optimise(of_study);
  compute::ResultStore store(request.store, studies::optimise_layout(of_study), if_exists_of(request));
  const auto optimum = std::make_shared<studies::Optimum>();
  run_with_threads(running.threads,
                   [&] { *optimum = studies::optimise(of_study, asked, store, nullptr, running.cancellation); });
  StudyResult result;
  result.complete = optimum->complete;
  result.is_yes = optimum->best.has_value();
  result.json = studies::optimum_json(of_study, asked, *optimum, seconds_since(start));
  result.csv = studies::front_csv(of_study, *optimum);
  result.table = studies::optimum_text(of_study, asked, *optimum);
  result.drawing = drawing_of([of_study, asked, optimum] { return report::optimum_plot(of_study, asked, *optimum); });
  return result;
}

}  // namespace retrace
