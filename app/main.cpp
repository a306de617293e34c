#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <exception>
#include <new>
#include <string>

#include "app/command_line.h"
#include "app/commands.h"
#include "app/interrupt.h"
#include "app/output.h"

namespace {

using namespace retrace;

ExitCode run(int argc, const char* const* argv) {
  const auto line = app::read_command_line(argc, argv);
  if (!line) return ExitCode::done;
  if (line->command == "rre") return app::run_rre_command(*line);
  if (line->command == "photometry") return app::run_photometry_command(*line);
  if (line->command == "roughness") return app::run_roughness_command(*line);
  if (line->command == "inspect") return app::run_inspect_command(*line);
  if (line->command == "metrology") return app::run_metrology_command(*line);
  if (line->command == "sweep") return app::run_sweep_command(*line);
  if (line->command == "job") return app::run_job_command(*line);
  if (line->command == "fabricate") return app::run_fabricate_command(*line);
  if (line->command == "optimize") return app::run_optimize_command(*line);
  if (line->command == "tolerance") return app::run_tolerance_command(*line);
  if (line->command == "verify") return app::run_verify_command(*line);
  if (line->command == "turn") return app::run_turn_command(*line);
  if (line->command == "plane") return app::run_plane_command(*line);
  if (line->command == "forces") return app::run_forces_command(*line);
  if (line->command == "image") return app::run_image_command(*line);
  if (line->command == "export") return app::run_export_command(*line);
  if (line->command == "report") return app::run_report_command(*line);
  if (line->command == "init") return app::run_init_command(*line);
  if (line->command == "schema") return app::run_schema_command(*line);
  return app::run_list_command(*line);
}

int fail(ExitCode code, const std::string& text) {
  app::say("retrace: " + text);
  return static_cast<int>(code);
}

/// With standard error closed, the next file that is opened would get its number, and our warnings with it.
void keep_standard_error_apart() {
  if (::fcntl(STDERR_FILENO, F_GETFD) != -1 || errno != EBADF) return;
  const int nowhere = ::open("/dev/null", O_WRONLY);
  if (nowhere < 0 || nowhere == STDERR_FILENO) return;
  ::dup2(nowhere, STDERR_FILENO);
  ::close(nowhere);
}

}  // namespace

int main(int argc, char** argv) {
  keep_standard_error_apart();
  app::install_interrupt_handlers();
  std::signal(SIGPIPE, SIG_IGN);  // a closed pipe is an output that cannot be written
  try {
    return static_cast<int>(run(argc, argv));
  } catch (const Error& error) {
    return fail(error.exit_code(), error.what());
  } catch (const std::bad_alloc&) {
    return fail(ExitCode::failed, "out of memory");
  } catch (const std::exception& error) {
    return fail(ExitCode::failed, error.what());
  }
}
