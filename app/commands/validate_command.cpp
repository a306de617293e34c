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
          .summary = "comparison of retrace with published values and closed forms",
          .manual =
              "Compares results of retrace with published values, closed forms and independent computations. Prints a "
              "page of Markdown with each value, its source, the result of retrace, the difference, and the allowed "
              "difference with its reason. `--out FILE` writes the page to a file. Exits with 1 if a difference is "
              "greater than allowed.",
          .writes = {"retrace.validation/1"},
          .refuses_set = "not allowed with validate, which uses its own designs",
          .begin = begins<ValidateOptions>(arguments, run)};
}

}  // namespace retrace::app
