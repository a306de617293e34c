#include "tests/app/program.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <thread>

#include "tests/support/refusals.h"

namespace retrace::test {
namespace fs = std::filesystem;
namespace {

std::string content(std::FILE* file) {
  std::string text;
  std::rewind(file);
  for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) text += static_cast<char>(c);
  return text;
}

/// Stores the arguments, the output and the files of a run for tools/same_bytes. They are stored in the folder that the
/// environment variable RETRACE_KEEP_RUNS names. Does nothing if the variable is not set.
void keep(const TemporaryFolder& folder, const Arguments& arguments, const Outcome& outcome) {
  const char* kept = std::getenv("RETRACE_KEEP_RUNS");
  if (kept == nullptr) return;
  static int runs = 0;
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  const fs::path place = fs::path(kept) / test->test_suite_name() / test->name() / std::to_string(++runs);
  fs::create_directories(place);
  fs::copy(folder.path(), place / "files", fs::copy_options::recursive | fs::copy_options::copy_symlinks);
  std::ofstream said(place / "said", std::ios::binary);
  for (std::size_t k = 1; k < arguments.size(); ++k) said << arguments[k] << '\n';
  said << "code " << outcome.code << '\n' << outcome.out << '\n' << outcome.err;
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
  std::string name = (fs::temp_directory_path() / "retrace_app_XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

void TemporaryFolder::write(const std::string& name, const std::string& text) const {
  std::ofstream stream(path_ / name, std::ios::binary);
  stream << text << std::flush;
  if (!stream) throw std::runtime_error("cannot write " + name);
}

std::string TemporaryFolder::read(const std::string& name) const {
  return read_text(path_ / name);
}

std::vector<std::string> TemporaryFolder::names() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(path_))
    names.push_back(entry.path().lexically_relative(path_).string());
  std::sort(names.begin(), names.end());
  return names;
}

namespace {

/// Returns the output of the program without the lines of the sanitizer's symbolizer. The symbolizer reports files that
/// it cannot read.
std::string said_by_program(std::string text) {
  constexpr std::string_view kSymbolizer = "LLVMSymbolizer: ";
  for (std::size_t at = 0; kIsSanitized && (at = text.find(kSymbolizer)) != std::string::npos;)
    text.erase(at, text.find('\n', at) + 1 - at);
  return text;
}

}  // namespace

Child::Child(const fs::path& folder, const Arguments& arguments, const std::string& input, Input kind,
             const std::string& out)
    : in_(std::tmpfile(), std::fclose),
      out_(out.empty() ? std::tmpfile() : std::fopen(out.c_str(), "w"), std::fclose),
      err_(std::tmpfile(), std::fclose) {
  if (!in_ || !out_ || !err_) throw std::runtime_error("no temporary file");
  std::fputs(input.c_str(), in_.get());
  std::rewind(in_.get());
  int pipe_ends[2] = {::fileno(in_.get()), -1};
  if (kind == Input::silent && ::pipe2(pipe_ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  silent_pipe_ = pipe_ends[1];

  std::vector<char*> words;
  for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  process_ = ::fork();
  if (process_ == 0) {
    ::dup2(pipe_ends[0], STDIN_FILENO);
    ::dup2(::fileno(out_.get()), STDOUT_FILENO);
    ::dup2(::fileno(err_.get()), STDERR_FILENO);
    if (::chdir(folder.c_str()) == 0) ::execv(words[0], words.data());
    ::_exit(127);
  }
  if (kind == Input::silent) ::close(pipe_ends[0]);
  if (process_ < 0) throw std::runtime_error("no child process");
}

Child::~Child() {
  if (process_ > 0) {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  if (silent_pipe_ >= 0) ::close(silent_pipe_);
}

void Child::interrupt(int signal) const {
  ::kill(process_, signal);
}

std::string Child::err_so_far() const {
  // Use pread(), which does not move the file offset. The child process shares this offset and writes there.
  std::string text;
  std::array<char, 4096> block{};
  for (;;) {
    const ssize_t count = ::pread(::fileno(err_.get()), block.data(), block.size(), static_cast<off_t>(text.size()));
    if (count <= 0) return text;
    text.append(block.data(), static_cast<std::size_t>(count));
  }
}

double Child::processor_time_s() const {
  clockid_t clock = {};
  timespec spent = {};
  if (::clock_getcpuclockid(process_, &clock) != 0 || ::clock_gettime(clock, &spent) != 0) return 0.0;
  return static_cast<double>(spent.tv_sec) + 1e-9 * static_cast<double>(spent.tv_nsec);
}

Outcome Child::wait() {
  int status = 0;
  rusage spent = {};
  ::wait4(process_, &status, 0, &spent);
  process_ = -1;
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), content(out_.get()),
          said_by_program(content(err_.get())), seconds(spent.ru_utime) + seconds(spent.ru_stime)};
}

bool Child::has_ended() const {
  siginfo_t what = {};
  return ::waitid(P_PID, static_cast<id_t>(process_), &what, WEXITED | WNOHANG | WNOWAIT) == 0 && what.si_pid != 0;
}

Outcome Child::wait(std::chrono::seconds limit) {
  const auto deadline = std::chrono::steady_clock::now() + limit;
  while (!has_ended() && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  if (!has_ended()) {
    ADD_FAILURE() << "still running after " << limit.count() << " s";
    // SIGTERM lets mpirun end its ranks before SIGKILL ends mpirun.
    ::kill(process_, SIGTERM);
    for (int k = 0; k < 100 && !has_ended(); ++k) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    ::kill(process_, SIGKILL);
  }
  return wait();
}

Outcome retrace(const TemporaryFolder& folder, Arguments arguments, const std::string& input, const std::string& out) {
  arguments.insert(arguments.begin(), RETRACE_PROGRAM);
  Outcome outcome = Child(folder.path(), arguments, input, Input::text, out).wait();
  keep(folder, arguments, outcome);
  return outcome;
}

Json retrace_json(const TemporaryFolder& folder, Arguments arguments, const std::string& input) {
  arguments.insert(arguments.end(), {"--json", "-"});
  const Outcome outcome = retrace(folder, arguments, input);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  return Json::parse(outcome.out, nullptr, false);
}

std::string refused_at(const Outcome& outcome, int code) {
  EXPECT_EQ(outcome.code, code) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  const std::vector<std::string> lines = lines_of(outcome.err);
  EXPECT_EQ(lines.size(), 1U) << outcome.err;
  if (lines.empty()) return "";
  EXPECT_TRUE(lines[0].starts_with("retrace: ")) << lines[0];
  return recorded_place_of(lines[0].substr(std::min<std::size_t>(9, lines[0].size())));
}

std::vector<std::string> warnings_of(const Outcome& outcome) {
  constexpr std::string_view kBegin = "warning: ";
  std::vector<std::string> warnings;
  for (const std::string& line : lines_of(outcome.err))
    if (line.starts_with(kBegin)) warnings.push_back(line.substr(kBegin.size()));
  for (const std::string& warning : warnings) record_message(warning);
  return warnings;
}

void expect_refused(const TemporaryFolder& folder, const std::vector<Refused>& cases, const Arguments& before,
                    const Arguments& after) {
  const std::vector<std::string> names = folder.names();
  for (const Refused& bad : cases) {
    const Arguments arguments = with(with(before, bad.arguments), after);
    EXPECT_EQ(refused_at(retrace(folder, arguments)), bad.place) << ::testing::PrintToString(arguments);
    EXPECT_EQ(folder.names(), names);
  }
}

Arguments with(Arguments arguments, const Arguments& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

std::string example(const std::string& name) {
  return std::string(RETRACE_SOURCE_DIR) + "/examples/" + name;
}

std::string read_text(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw std::runtime_error("cannot read " + file.string());
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::string without_texture(const std::string& design) {
  std::string rest;
  for (const std::string& line : lines_of(design)) {
    const bool is_texture =
        std::ranges::any_of(std::array{"model = ", "roughness_sq_nm", "correlation_length_um", "waviness_"},
                            [&](const char* key) { return line.starts_with(key); });
    if (!is_texture) rest += line + "\n";
  }
  return rest;
}

std::string without_elapsed(const std::string& json) {
  const std::string text = std::regex_replace(json, std::regex("\"elapsed_s\": [^,\n]*"), "");
  EXPECT_NE(text, json) << "no elapsed_s";
  return text;
}

}  // namespace retrace::test
