#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/output.h"
#include "core/atomic_file.h"
#include "core/json_text.h"
#include "core/version.h"
#include "studies/design/init_templates.h"

namespace retrace::app {
namespace fs = std::filesystem;

ExitCode run_init_command(const CommandLine& line) {
  const std::string text = studies::design_template(line.kind);
  if (!line.common.overrides.empty())
    throw InputError({"", 0, "--set"}, "init writes its template as it is; edit the file");
  const nlohmann::ordered_json json = {{"schema", "retrace.template/1"},
                                       {"kind", line.kind},
                                       {"text", text},
                                       {"version", kVersion},
                                       {"warnings", nlohmann::ordered_json::array()},
                                       {"complete", true}};
  // With init, --out names the design file, not a folder.
  const std::string out = line.common.out;
  CommonOptions outputs = line.common;
  outputs.out.clear();
  // Somebody's design may be there: starting afresh is not worth losing it.
  if (!out.empty() && fs::symlink_status(out).type() != fs::file_type::not_found)
    throw OutputError(out + ": is there already; not overwritten");
  prepare_outputs(outputs, {});
  if (!out.empty()) write_file_atomically(out, text);
  // Without --out the template is the result itself, which --quiet does not take away.
  outputs.quiet = line.common.quiet && !out.empty();
  write_outputs(outputs, to_text(json), {}, out.empty() ? text : "wrote " + out + "\n");
  return ExitCode::done;
}

}  // namespace retrace::app
