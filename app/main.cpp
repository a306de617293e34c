#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "app/command_line.h"
#include "app/commands.h"
#include "app/interrupt.h"

namespace {

using namespace retrace;

ExitCode run(int argc, const char* const* argv) {
  const auto line = app::read_command_line(argc, argv);
  if (!line) return ExitCode::done;
  if (line->command == "rre") return app::run_rre_command(*line);
  if (line->command == "inspect") return app::run_inspect_command(*line);
  if (line->command == "init") return app::run_init_command(*line);
  return app::run_list_command(*line);
}

int fail(ExitCode code, std::string text) {
  // An error is one line, whatever a file is called.
  std::replace(text.begin(), text.end(), '\n', ' ');
  fmt::print(stderr, "retrace: {}\n", text);
  return static_cast<int>(code);
}

}  // namespace

int main(int argc, char** argv) {
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
