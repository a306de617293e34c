#include <fmt/format.h>

#include "app/commands.h"
#include "app/interrupt.h"
#include "app/output.h"
#include "studies/validation/io/validation_files.h"
#include "studies/validation/validation.h"

namespace retrace::app {
namespace {

struct ValidateOptions {};

std::vector<Argument> arguments(ValidateOptions&) {
  return {};
}

ExitCode run(const ValidateOptions&, const CommonOptions& common) {
  TextFiles files(common);
  const OrderlyInterrupt interrupt;
  studies::ValidationResult result;
  interrupt.run(common, {"computing"}, [&](Progress* bar, const Cancellation* cancel) {
    result = studies::validate(studies::validation_rows(), bar, cancel);
  });
  return files.write(studies::validation_json(result), studies::validation_markdown(result),
                     studies::validation_warnings(result),
                     {.complete = result.complete,
                      .interrupted = fmt::format("finished figures: {}", result.rows.size()),
                      .is_yes = result.holds()});
}

}  // namespace

Command validate_command() {
  return {.name = "validate",
          .summary = "published figures and closed forms beside what retrace computes",
          .manual =
              "Computes every published figure, closed form and independent computation that retrace is held "
              "against, and prints a page of Markdown with each, its source, what retrace makes of it, the "
              "difference, and the difference that is allowed, with the reason. With `--out FILE` the page goes "
              "to that file. The exit code is 1 if a difference is not allowed.",
          .writes = {"retrace.validation/1"},
          .refuses_set = "validate has designs of its own",
          .begin = begins<ValidateOptions>(arguments, run)};
}

}  // namespace retrace::app
