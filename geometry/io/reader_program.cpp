#include "geometry/io/reader_program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <system_error>

#include "core/error.h"
#include "core/installation.h"

// NOLINTNEXTLINE: POSIX declares this variable without a header.
extern char** environ;

namespace retrace::geometry {
namespace {

using ReaderClock = std::chrono::steady_clock;

/// End of a pipe, which is closed automatically.
class PipeEnd {
 public:
  explicit PipeEnd(int number) : number_(number) {}
  PipeEnd(const PipeEnd&) = delete;
  PipeEnd& operator=(const PipeEnd&) = delete;
  ~PipeEnd() { close(); }
  int number() const { return number_; }
  void close() {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }

 private:
  int number_;
};

/// Running program. It is killed at the end of the object's life.
class RunningProgram {
 public:
  RunningProgram(const std::filesystem::path& program, std::vector<std::string> words, const PipeEnd& output) {
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    ::posix_spawn_file_actions_adddup2(&actions, output.number(), STDOUT_FILENO);
    const int fault = ::posix_spawn(&id_, program.c_str(), &actions, nullptr, arguments.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    if (fault == 0) return;
    id_ = -1;
    throw InputError(fmt::format("cannot be read, because the program {} cannot be started: {}", program.string(),
                                 std::generic_category().message(fault)));
  }
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;
  ~RunningProgram() {
    if (id_ <= 0) return;
    ::kill(id_, SIGKILL);
    wait();
  }
  /// Waits for the end of the program, and returns its status as waitpid() does.
  int wait() {
    int status = 0;
    while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
    id_ = -1;
    return status;
  }

 private:
  pid_t id_ = -1;
};

[[noreturn]] void refuse_slow_reading() {
  throw InputError(
      fmt::format("must be readable within {} s, but reading takes longer: export fewer faces from the CAD "
                  "program",
                  kMaxReaderSeconds));
}

[[noreturn]] void refuse_broken_pipe() {
  throw InputError(fmt::format("cannot be read: {}", std::generic_category().message(errno)));
}

/// Reads a pipe up to its end.
std::string text_of_pipe(const PipeEnd& pipe, ReaderClock::time_point end) {
  std::string text;
  std::array<char, 65536> block{};
  while (true) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - ReaderClock::now()).count();
    if (left <= 0) refuse_slow_reading();
    pollfd waiting{pipe.number(), POLLIN, 0};
    const int ready = ::poll(&waiting, 1, static_cast<int>(left));
    if (ready < 0 && errno != EINTR) refuse_broken_pipe();
    if (ready <= 0) continue;
    const ssize_t bytes = ::read(pipe.number(), block.data(), block.size());
    if (bytes == 0) return text;
    if (bytes < 0 && errno != EINTR) refuse_broken_pipe();
    if (bytes > 0) text.append(block.data(), static_cast<std::size_t>(bytes));
  }
}

}  // namespace

std::string output_of_reader(std::string_view name, std::vector<std::string> arguments, std::string_view package) {
  const std::filesystem::path program = installation_folder() / "lib" / "retrace" / name;
  std::error_code ignored;
  if (!std::filesystem::exists(program, ignored))
    throw InputError(
        fmt::format("cannot be read, because retrace was built without OpenCASCADE: {} is missing", program.string()));
  arguments.insert(arguments.begin(), std::string(name));
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) refuse_broken_pipe();
  const PipeEnd from_program(ends[0]);
  PipeEnd to_parent(ends[1]);
  // Other processes may slow the program down. The time limit of the clock is therefore longer than that of the
  // program.
  const ReaderClock::time_point end = ReaderClock::now() + std::chrono::seconds(6 * kMaxReaderSeconds);
  RunningProgram running(program, std::move(arguments), to_parent);
  to_parent.close();
  std::string text = text_of_pipe(from_program, end);
  const int status = running.wait();
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) refuse_slow_reading();
  if (WIFSIGNALED(status))
    throw InputError(fmt::format("cannot be read: OpenCASCADE ended with the signal {}", WTERMSIG(status)));
  if (WEXITSTATUS(status) != 0)
    throw InputError(
        fmt::format("cannot be read: OpenCASCADE is missing or damaged; install the Debian package {}", package));
  return text;
}

}  // namespace retrace::geometry
