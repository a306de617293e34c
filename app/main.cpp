#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <exception>
#include <new>
#include <string>

#include "app/command_line.h"
#include "app/interrupt.h"
#include "app/output.h"

namespace {

using namespace retrace;

ExitCode run(int argc, const char* const* argv) {
  const auto command = app::read_command_line(argc, argv);
  return command ? command() : ExitCode::done;
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
