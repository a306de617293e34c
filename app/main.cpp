#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <new>

#include "app/command_line.h"
#include "app/commands.h"

namespace {

using namespace retrace;

Cancellation cancellation;

/// The first interrupt asks the work to end in order, the second ends it at once.
extern "C" void on_interrupt(int signal) {
  cancellation.request();
  std::signal(signal, SIG_DFL);
}

ExitCode run(int argc, const char* const* argv) {
  const auto line = app::read_command_line(argc, argv);
  if (!line) return ExitCode::done;
  if (line->command == "rre") return app::run_rre_command(*line, cancellation);
  if (line->command == "inspect") return app::run_inspect_command(*line);
  if (line->command == "init") return app::run_init_command(*line);
  return app::run_list_command(*line);
}

int fail(ExitCode code, const char* text) {
  fmt::print(stderr, "retrace: {}\n", text);
  return static_cast<int>(code);
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
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
