#include "studies/closed_loop/verification.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "fabrication/job/io/job_files.h"
#include "fabrication/machine/io/machine_files.h"

namespace retrace::studies {
namespace {

using namespace fabrication;

NcDialect dialect_of(const std::string& word, std::string_view text, const std::string& file) {
  if (word == "auto") return recognise_dialect(text, file);
  const auto* const found = std::find(std::begin(kNcDialectWords), std::end(kNcDialectWords), word);
  if (found == std::end(kNcDialectWords))
    throw InputError({"", 0, "--dialect"},
                     fmt::format("must be \"auto\", {}, got {}", alternatives(kNcDialectWords), in_quotes(word)));
  return static_cast<NcDialect>(found - std::begin(kNcDialectWords));
}

NcTexts nc_texts_of(const Control& control) {
  return {"", "", control.mist_on, control.mist_off, control.optional_stop};
}

}  // namespace

VerificationRun run_verification(const VerificationRequest& request, const Cancellation* cancellation) {
  if (!(request.tolerance_nm > 0.0) || !std::isfinite(request.tolerance_nm))
    throw InputError({"", 0, "--tolerance-nm"}, "must be > 0, got " + shortest(request.tolerance_nm));
  VerificationRun run;
  run.request = request;
  run.job = read_job(request.job);
  run.machine = load_machine(run.job.machine, run.job.where("machine"));
  for (const std::string& file : request.programs) {
    const std::string text = read_file(file, kMostDataBytes);
    run.dialects.push_back(dialect_of(request.dialect, text, file));
    run.programs.push_back(parse_nc(text, file, run.dialects.back(), nc_texts_of(run.machine.control)));
  }
  VerifyOptions options;
  options.tolerance_nm = request.tolerance_nm;
  run.result = verify_programs(run.job, run.machine, run.programs, options, shipped_machines(), cancellation);
  return run;
}

ErrorMap error_map(const VerificationRun& run) {
  constexpr std::size_t kPixels = 900;
  constexpr double kTolerances = 5.0;
  constexpr double kMargin = 1.2;
  ErrorMap map;
  map.field = fabrication::error_field(run.job, run.machine, run.programs, kPixels);
  // What is unavoidable is seen whole; faults are seen where they are, not how large.
  map.shown_nm = std::max(kTolerances * run.result.tolerance_nm, kMargin * run.result.root_residual_nm_predicted);
  return map;
}

}  // namespace retrace::studies
