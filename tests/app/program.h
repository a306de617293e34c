#pragma once

#include <sys/types.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace retrace::test {

using Arguments = std::vector<std::string>;
using Json = nlohmann::ordered_json;

/// Result of a run. `code` is the exit code, or -n if signal n ended the program.
struct Outcome {
  int code = 0;
  std::string out;
  std::string err;
  double processor_time_s = 0.0;  ///< processor time of all threads
};

/// A new temporary folder. The destructor removes the folder and its contents.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  void write(const std::string& name, const std::string& text) const;
  std::string read(const std::string& name) const;
  Json json(const std::string& name) const { return Json::parse(read(name)); }
  /// Returns the sorted names of all files and folders in the folder, including hidden and nested ones.
  std::vector<std::string> names() const;

 private:
  std::filesystem::path path_;
};

/// Source of standard input.
enum class Input {
  text,   ///< the given text
  silent  ///< a pipe that stays open and contains nothing
};

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define RETRACE_IS_SANITIZED
#endif
#endif
#ifdef RETRACE_IS_SANITIZED
inline constexpr bool kIsSanitized = true;
#else
inline constexpr bool kIsSanitized = false;
#endif

/// Returns a generous time limit. With sanitizers it is ten times as long, because they make programs about ten times
/// slower.
constexpr std::chrono::seconds patient(int seconds) {
  return std::chrono::seconds(kIsSanitized ? 10 * seconds : seconds);
}

/// A program that runs as a child process, without a shell. The first argument is the program.
class Child {
 public:
  /// \param out file for standard output. If it is empty, standard output is captured
  Child(const std::filesystem::path& folder, const Arguments& arguments, const std::string& input = {},
        Input kind = Input::text, const std::string& out = {});
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  void interrupt(int signal = SIGINT) const;
  Outcome wait();
  /// Waits for a child that must end within `limit`. Otherwise the test fails, and the child is killed.
  Outcome wait(std::chrono::seconds limit);
  /// Returns true if the child has ended. wait() still returns the result of the child afterwards.
  bool has_ended() const;
  /// Returns the text that the child has written to standard error so far.
  std::string err_so_far() const;
  /// Returns the processor time that all threads of the child have used so far.
  /// \pre wait() has not been called
  double processor_time_s() const;

 private:
  using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

  File in_;
  File out_;
  File err_;
  int silent_pipe_ = -1;  ///< write end of the pipe, which is never used
  pid_t process_ = -1;
};

/// Runs retrace in `folder`.
/// \param input text on standard input
/// \param out file for standard output. If it is empty, standard output is captured
Outcome retrace(const TemporaryFolder& folder, Arguments arguments, const std::string& input = {},
                const std::string& out = {});

/// Runs retrace and returns the JSON document that `--json -` prints. The exit code of the run must be 0.
Json retrace_json(const TemporaryFolder& folder, Arguments arguments, const std::string& input = {});

/// Returns `file:line: key` of the message of a refused run. Parts that the message does not contain are omitted.
/// Expects the exit code, nothing on standard output, and one line on standard error, which is recorded in
/// tests/messages.txt.
std::string refused_at(const Outcome& outcome, int code = 2);

/// Returns the warnings of a run, and records them in tests/messages.txt.
std::vector<std::string> warnings_of(const Outcome& outcome);

/// Arguments that are refused, and `file:line: key` of the message.
struct Refused {
  Arguments arguments;
  std::string place;
};

/// Expects that runs in `folder` are refused and write nothing.
/// \param before arguments before the arguments of each case
/// \param after arguments after the arguments of each case
void expect_refused(const TemporaryFolder& folder, const std::vector<Refused>& cases, const Arguments& before,
                    const Arguments& after = {"-o", "out", "--json", "r.json"});

/// Returns the arguments followed by `more`.
Arguments with(Arguments arguments, const Arguments& more);

/// Returns the path of a file in examples/.
std::string example(const std::string& name);
std::string read_text(const std::filesystem::path& file);
std::vector<std::string> lines_of(const std::string& text);
/// Returns the text of a design without the keys of its surface texture.
std::string without_texture(const std::string& design);

/// Returns a result without the line or the member that contains the elapsed time. Only this time may differ between
/// runs.
std::string without_elapsed(const std::string& json);

/// Replaces the machine of a job by a copy with lines for mist. A Power PMAC has no standard codes for mist.
inline void give_mist_lines(const TemporaryFolder& folder, const std::string& job_file) {
  std::string job = folder.read(job_file);
  const std::size_t begin = job.find("machine = \"") + 11;
  const std::string name = job.substr(begin, job.find('"', begin) - begin);
  folder.write("machine.toml", read_text(std::string(RETRACE_SOURCE_DIR) + "/data/machines/" + name + ".toml") +
                                   "\n[control]\nmist_on = \"M107\"\nmist_off = \"M109\"\n");
  folder.write(job_file, job.replace(begin, name.size(), "machine.toml"));
}

}  // namespace retrace::test
