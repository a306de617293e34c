#include <filesystem>

#include "app/commands.h"
#include "app/output.h"
#include "core/atomic_file.h"
#include "studies/design/init_templates.h"

namespace retrace::app {

ExitCode run_init_command(const CommandLine& line) {
  const std::string text = studies::design_template(line.kind);
  if (line.common.out.empty()) {
    print(text);
    return ExitCode::done;
  }
  // Somebody's design may be there: starting afresh is not worth losing it.
  if (std::filesystem::exists(line.common.out)) throw OutputError(line.common.out + ": is there already; not overwritten");
  write_file_atomically(line.common.out, text);
  if (!line.common.quiet) print("wrote " + line.common.out + "\n");
  return ExitCode::done;
}

}  // namespace retrace::app
