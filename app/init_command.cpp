#include <filesystem>

#include "app/commands.h"
#include "app/output.h"
#include "studies/design/init_templates.h"

namespace retrace::app {
namespace {

struct InitOptions {
  std::string kind;
};

std::vector<Argument> arguments(InitOptions& options) {
  const auto kinds = [] {
    Words words = words_of(studies::design_kinds())();
    words.emplace_back("round_zone_lens");
    return words;
  };
  return {{"KIND", "rtp, hexagonal_icc, triangular_icc or round_zone_lens", &options.kind, one_of(kinds)}};
}

ExitCode run(const InitOptions& options, const CommonOptions& common) {
  const std::string text = studies::design_template(options.kind);
  // Somebody's design may be there: starting afresh is not worth losing it.
  if (!common.out.empty() &&
      std::filesystem::symlink_status(common.out).type() != std::filesystem::file_type::not_found)
    throw OutputError(common.out + ": is there already; not overwritten");
  return write_text(common, "retrace.template/1", {{"kind", options.kind}}, text);
}

}  // namespace

Command init_command() {
  return {.name = "init",
          .summary = "a commented design or part file to start from",
          .manual =
              "Prints a commented design that works as it is, or of kind `round_zone_lens` a part for `plane`. "
              "With `--out FILE` it goes to that file, which must not exist yet.",
          .writes = {"retrace.template/1"},
          .refuses_set = "init writes its template as it is; edit the file",
          .begin = begins<InitOptions>(arguments, run)};
}

}  // namespace retrace::app
