#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <string_view>

#include "app/command_line.h"
#include "app/interrupt.h"
#include "app/output.h"
#include "requests/row.h"

namespace {

using namespace retrace;

ExitCode run(int argc, const char* const* argv) {
  const auto command = app::read_command_line(argc, argv);
  return command ? command() : ExitCode::done;
}

int fail(ExitCode code, const std::string& text) {
  app::print_to_stderr("retrace: " + text);
  return static_cast<int>(code);
}

/// Ends the program when an allocation fails. No exception is thrown, because destructors and noexcept functions may
/// need memory as well and libraries may hold locks. Finished points of a study are not lost, because they are already
/// in its store.
[[noreturn]] void end_without_memory() {
  constexpr std::string_view text =
      "retrace: out of memory; the finished points of a study are kept, and --resume continues from them\n";
  static_cast<void>(!::write(STDERR_FILENO, text.data(), text.size()));
  ::_exit(static_cast<int>(ExitCode::failed));
}

/// Terminate handler. Ends the program with the message of the current exception, for example if an exception leaves a
/// noexcept function.
[[noreturn]] void end_on_exception() {
  try {
    if (std::current_exception()) std::rethrow_exception(std::current_exception());
  } catch (const std::bad_alloc&) {
    end_without_memory();
  } catch (const std::exception& error) {
    ::_exit(fail(ExitCode::failed, error.what()));
  } catch (...) {
  }
  std::abort();
}

/// Opens /dev/null as standard error if standard error is closed. The next file that is opened would otherwise get the
/// descriptor of standard error, and warnings would be written to that file.
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
  std::signal(SIGPIPE, SIG_IGN);  // writing to a closed pipe then fails with an error message
  std::set_new_handler(end_without_memory);
  std::set_terminate(end_on_exception);
  try {
    return static_cast<int>(run(argc, argv));
  } catch (const Error& error) {
    return fail(error.exit_code(), error.message(requests::option_of_field));
  } catch (const std::bad_alloc&) {  // thrown by libraries that do not allocate memory with new
    end_without_memory();
  } catch (const std::filesystem::filesystem_error& error) {
    return fail(ExitCode::failed, error.path1().string() + ": " + error.code().message());
  } catch (const std::exception& error) {
    return fail(ExitCode::failed, error.what());
  }
}
