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
#include <string_view>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "core/installation.h"
#include "core/number_format.h"

// NOLINTNEXTLINE: POSIX declares this variable without a header.
extern char** environ;

namespace retrace::geometry {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::string_view kProgram = "retrace_step_reader";
/// Maximum length of a result.
constexpr std::size_t kMaxResultBytes = std::size_t{1} << 30;
/// Maximum time from start to end. On a machine with other work, it is longer than the processor time.
constexpr std::chrono::seconds kMaxWait{60};

/// End of a pipe, which is closed automatically.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close(); }
  int number() const { return number_; }
  void close() {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }

 private:
  int number_;
};

/// Running process. It is killed at the end of the object's life.
class ChildProcess {
 public:
  explicit ChildProcess(pid_t id) : id_(id) {}
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  ~ChildProcess() {
    if (id_ <= 0) return;
    ::kill(id_, SIGKILL);
    wait();
  }
  /// Waits for the end of the process, and returns its status as waitpid() does.
  int wait() {
    int status = 0;
    while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
    id_ = -1;
    return status;
  }

 private:
  pid_t id_;
};

/// Starts a program whose standard output is `output`. Its other streams are /dev/null. It does not receive signals of
/// the terminal, because this program handles interrupts itself.
ChildProcess started(const fs::path& program, std::vector<std::string> words, const Descriptor& output) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  ::posix_spawn_file_actions_adddup2(&actions, output.number(), STDOUT_FILENO);
  posix_spawnattr_t attributes;
  ::posix_spawnattr_init(&attributes);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  pid_t id = -1;
  const int fault = ::posix_spawn(&id, program.c_str(), &actions, &attributes, arguments.data(), environ);
  ::posix_spawnattr_destroy(&attributes);
  ::posix_spawn_file_actions_destroy(&actions);
  if (fault != 0)
    throw InputError(fmt::format("cannot be read, because the program {} cannot be started: {}", program.string(),
                                 std::generic_category().message(fault)));
  return ChildProcess(id);
}

[[noreturn]] void refuse_slow() {
  throw InputError(
      fmt::format("must be readable within {} s, but reading takes longer: export fewer faces from the CAD "
                  "program",
                  shortest(kMaxStepSeconds)));
}

[[noreturn]] void refuse_broken_pipe() {
  throw InputError(fmt::format("cannot be read: {}", std::generic_category().message(errno)));
}

/// Reads a pipe up to its end.
std::string read_pipe(const Descriptor& pipe, Clock::time_point end) {
  std::string text;
  std::array<char, 65536> block{};
  while (true) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
    if (left <= 0) refuse_slow();
    pollfd waiting{pipe.number(), POLLIN, 0};
    const int ready = ::poll(&waiting, 1, static_cast<int>(left));
    if (ready < 0 && errno != EINTR) refuse_broken_pipe();
    if (ready <= 0) continue;
    const ssize_t bytes = ::read(pipe.number(), block.data(), block.size());
    if (bytes == 0) return text;
    if (bytes < 0 && errno != EINTR) refuse_broken_pipe();
    if (bytes > 0) text.append(block.data(), static_cast<std::size_t>(bytes));
    if (text.size() > kMaxResultBytes) throw InputError("cannot be read: it has too many faces");
  }
}

}  // namespace

std::string result_of_step_program(std::vector<std::string> words) {
  const fs::path program = installation_folder() / "lib" / "retrace" / kProgram;
  std::error_code ignored;
  if (!fs::exists(program, ignored))
    throw InputError(
        fmt::format("cannot be read, because retrace was built without OpenCASCADE: {} is missing", program.string()));
  words.insert(words.begin(), std::string(kProgram));
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw InputError(fmt::format("cannot be read: {}", std::generic_category().message(errno)));
  const Descriptor from_program(ends[0]);
  Descriptor to_parent(ends[1]);
  const Clock::time_point end = Clock::now() + kMaxWait;
  ChildProcess process = started(program, std::move(words), to_parent);
  to_parent.close();
  std::string result = read_pipe(from_program, end);
  const int status = process.wait();
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) refuse_slow();
  if (WIFSIGNALED(status))
    throw InputError(fmt::format("cannot be read: OpenCASCADE ended with the signal {}", WTERMSIG(status)));
  if (WEXITSTATUS(status) != 0)
    throw InputError(
        "cannot be read: OpenCASCADE or its Debian package libocct-data-exchange-7.6 is missing or damaged");
  return result;
}

}  // namespace retrace::geometry
