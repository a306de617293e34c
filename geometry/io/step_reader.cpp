#include "geometry/io/step_reader.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <map>
#include <mutex>
#include <system_error>
#include <utility>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/installation.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "geometry/io/step_message.h"

// NOLINTNEXTLINE: POSIX declares this variable without a header.
extern char** environ;

namespace retrace::geometry {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::string_view kProgram = "retrace_step_reader";
constexpr std::size_t kMaxMessageBytes = 400;
/// Maximum length of a result.
constexpr std::size_t kMaxResultBytes = std::size_t{64} << 20;
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

/// Reads a pipe up to its end.
std::string read_pipe(const Descriptor& pipe, Clock::time_point end) {
  std::string text;
  std::array<char, 65536> block{};
  while (true) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
    if (left <= 0) refuse_slow();
    pollfd waiting{pipe.number(), POLLIN, 0};
    const int ready = ::poll(&waiting, 1, static_cast<int>(left));
    if (ready < 0 && errno != EINTR) StepMessageReader::fail();
    if (ready <= 0) continue;
    const ssize_t bytes = ::read(pipe.number(), block.data(), block.size());
    if (bytes == 0) return text;
    if (bytes < 0 && errno != EINTR) StepMessageReader::fail();
    if (bytes > 0) text.append(block.data(), static_cast<std::size_t>(bytes));
    if (text.size() > kMaxResultBytes) StepMessageReader::fail();
  }
}

/// Runs the program that reads STEP files, and returns its result.
std::string result_of_program(const StepChoice& choice, std::string_view kind) {
  const fs::path program = installation_folder() / "lib" / "retrace" / kProgram;
  std::error_code ignored;
  if (!fs::exists(program, ignored))
    throw InputError(
        fmt::format("cannot be read, because retrace was built without OpenCASCADE: {} is missing", program.string()));
  std::vector<std::string> words = {std::string(kProgram), std::string(kind), choice.file.string(), choice.face,
                                    shortest(choice.sew_mm)};
  for (const double angle : choice.rotation_deg) words.push_back(shortest(angle));
  if (choice.origin_mm)
    for (const double c : *choice.origin_mm) words.push_back(shortest(c));
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

PatchTree tree_of(StepMessageReader& reader) {
  PatchTree tree;
  tree.patches = reader.list<HeightPatch>([&] {
    HeightPatch patch;
    patch.centre_mm = reader.point();
    patch.half_mm = reader.point();
    for (double& coefficient : patch.coefficients) coefficient = reader.number();
    return patch;
  });
  const std::size_t nodes = reader.count();
  for (std::size_t k = 0; k < nodes; ++k) {
    PatchNode node;
    node.axis = static_cast<int>(reader.index(3)) - 1;
    node.split_mm = reader.number();
    if (node.axis >= 0) {
      node.first = reader.index(nodes);
      node.second = reader.index(nodes);
      if (node.first <= k || node.second <= k) StepMessageReader::fail();
    } else if (const std::uint32_t patch = reader.index(tree.patches.size() + 1); patch > 0) {
      node.first = patch - 1;
    }
    tree.nodes.push_back(node);
  }
  if (tree.nodes.empty()) StepMessageReader::fail();
  return tree;
}

StepSurface surface_of_result(StepMessageReader& reader) {
  std::vector<PatchTree> faces = reader.list<PatchTree>([&] { return tree_of(reader); });
  const auto loop = [&] { return reader.list<Vec2>([&] { return reader.point(); }); };
  std::vector<FaceBorder> borders = reader.list<FaceBorder>([&] { return reader.list<std::vector<Vec2>>(loop); });
  if (faces.empty() || faces.size() != borders.size()) StepMessageReader::fail();
  StepSurface surface{.patches = PatchSurface(std::move(faces), std::move(borders))};
  surface.origin_mm = reader.position();
  surface.size_mm = reader.point();
  surface.unit = reader.text();
  surface.deviation_mm = reader.number();
  surface.deviation_arcsec = reader.number();
  surface.gap_mm = reader.number();
  surface.breaks = reader.list<TangentBreak>([&] {
    const double angle_deg = reader.number();
    return TangentBreak{angle_deg, reader.position()};
  });
  return surface;
}

std::vector<OutlineLoop> loops_of_result(StepMessageReader& reader) {
  return reader.list<OutlineLoop>([&] {
    return reader.list<OutlineSide>([&] {
      const Vec2 from = reader.point();
      const Vec2 to = reader.point();
      return OutlineSide{from, to, reader.number()};
    });
  });
}

/// Runs the program, and converts its result.
/// \param convert function that reads the part of the result behind its first number
template <class Convert>
auto converted(const StepChoice& choice, std::string_view kind, StepResult expected, const Convert& convert) {
  try {
    const std::string result = result_of_program(choice, kind);
    StepMessageReader reader(result);
    const double first = reader.number();
    if (first == static_cast<double>(StepResult::refused)) throw InputError(printable(reader.text(), kMaxMessageBytes));
    if (first != static_cast<double>(expected)) StepMessageReader::fail();
    return convert(reader);
  } catch (const InputError& error) {
    throw InputError({choice.file.string(), 0, ""}, error.what());
  } catch (const std::runtime_error& error) {
    throw InputError({choice.file.string(), 0, ""},
                     fmt::format("cannot be read by OpenCASCADE: {}", printable(error.what(), kMaxMessageBytes)));
  }
}

/// Text that differs for files and selections with different results.
std::string identity_of(const StepChoice& choice) {
  std::error_code ignored;
  const auto time = fs::last_write_time(choice.file, ignored).time_since_epoch().count();
  std::string identity = fmt::format("{}\n{}\n{}\n{}\n{}", fs::absolute(choice.file, ignored).string(), time,
                                     fs::file_size(choice.file, ignored), choice.face, shortest(choice.sew_mm));
  for (const double angle : choice.rotation_deg) identity += "\n" + shortest(angle);
  if (choice.origin_mm)
    for (const double c : *choice.origin_mm) identity += "\n" + shortest(c);
  return identity;
}

/// Results that were read before. A sweep reads each design many times, but its STEP files only one time.
template <class Result>
class KeptResults {
 public:
  template <class Read>
  std::shared_ptr<const Result> get(const StepChoice& choice, const Read& read) {
    require_short_file(choice.file, kMaxStepBytes);
    std::error_code ignored;
    if (!fs::exists(choice.file, ignored)) static_cast<void>(read_file(choice.file, kMaxStepBytes));
    const std::string identity = identity_of(choice);
    const std::lock_guard lock(mutex_);
    if (const auto known = results_.find(identity); known != results_.end()) return known->second;
    if (results_.size() >= kMaxResults) results_.clear();
    return results_.emplace(identity, std::make_shared<const Result>(read())).first->second;
  }

 private:
  static constexpr std::size_t kMaxResults = 64;

  std::mutex mutex_;
  std::map<std::string, std::shared_ptr<const Result>> results_;
};

}  // namespace

std::shared_ptr<const StepSurface> read_step_surface(const StepChoice& choice) {
  static KeptResults<StepSurface> kept;
  return kept.get(choice, [&] { return converted(choice, kStepSurfaceWord, StepResult::surface, surface_of_result); });
}

std::vector<OutlineLoop> read_step_outline(const StepChoice& choice) {
  static KeptResults<std::vector<OutlineLoop>> kept;
  return *kept.get(choice, [&] { return converted(choice, kStepOutlineWord, StepResult::outline, loops_of_result); });
}

}  // namespace retrace::geometry
