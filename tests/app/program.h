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

/// What a program left behind. `code` is its exit code, or -n if signal n ended it.
struct Outcome {
  int code = 0;
  std::string out;
  std::string err;
  double processor_time_s = 0.0;  ///< of all its threads
};

/// A folder of its own, removed with everything in it.
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
  /// Everything in it, hidden files and files of folders included, sorted.
  std::vector<std::string> names() const;

 private:
  std::filesystem::path path_;
};

/// Where standard input comes from.
enum class Input {
  text,   ///< what was given
  silent  ///< a pipe that stays open and says nothing
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

/// A limit on time that programs keep by far, also with sanitizers, which make them some ten times as slow.
constexpr std::chrono::seconds patient(int seconds) {
  return std::chrono::seconds(kIsSanitized ? 10 * seconds : seconds);
}

/// A program that runs as a child process, without a shell between. The first argument is the program.
class Child {
 public:
  /// \param out file to be its standard output; empty: it is caught
  Child(const std::filesystem::path& folder, const Arguments& arguments, const std::string& input = {},
        Input kind = Input::text, const std::string& out = {});
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  void interrupt(int signal = SIGINT) const;
  Outcome wait();
  /// The same for a child that must end in time: one that does not is a failure of the test, and is killed.
  Outcome wait(std::chrono::seconds limit);
  /// Whether it has ended; what it left behind is still told by wait().
  bool has_ended() const;
  /// Returns what it has written to standard error so far.
  std::string err_so_far() const;
  /// Time of the processor that its threads have spent so far. \pre wait() has not been called
  double processor_time_s() const;

 private:
  using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

  File in_;
  File out_;
  File err_;
  int silent_pipe_ = -1;  ///< the end that would be written to
  pid_t process_ = -1;
};

/// Runs retrace in `folder`. \param input text on standard input \param out file to be its standard output
Outcome retrace(const TemporaryFolder& folder, Arguments arguments, const std::string& input = {},
                const std::string& out = {});

/// The same, for a run that must say it is done and complain of nothing: the JSON that `--json -` prints.
Json retrace_json(const TemporaryFolder& folder, Arguments arguments, const std::string& input = {});

/// Expects a run to have ended so, with nothing on standard output and one line that says what was wrong, from where it
/// begins.
void expect_refused(const Outcome& outcome, const std::string& begin, int code = 2);
/// The same of a line that has the words anywhere.
void expect_refused_with(const Outcome& outcome, const std::string& words);

/// Arguments that are refused, and how the message begins.
struct Refused {
  Arguments arguments;
  std::string begin;
};

/// Expects runs in `folder` to be refused and to write nothing. \param before, after the arguments of each case
void expect_refused(const TemporaryFolder& folder, const std::vector<Refused>& cases, const Arguments& before,
                    const Arguments& after = {"-o", "out", "--json", "r.json"});

/// The arguments, and more.
Arguments with(Arguments arguments, const Arguments& more);

/// A file of examples/.
std::string example(const std::string& name);
std::string read_text(const std::filesystem::path& file);
std::vector<std::string> lines_of(const std::string& text);
/// The text of a design without the keys of its surfaces' texture.
std::string without_texture(const std::string& design);

/// A result without its line or member on elapsed time, the only thing that may differ from run to run.
std::string without_elapsed(const std::string& json);

/// Gives the shipped machine of a job lines for mist, which a Power PMAC has no words of its own for.
inline void give_mist_lines(const TemporaryFolder& folder, const std::string& job_file) {
  std::string job = folder.read(job_file);
  const std::size_t begin = job.find("machine = \"") + 11;
  const std::string name = job.substr(begin, job.find('"', begin) - begin);
  folder.write("machine.toml", read_text(std::string(RETRACE_SOURCE_DIR) + "/data/machines/" + name + ".toml") +
                                   "\n[control]\nmist_on = \"M107\"\nmist_off = \"M109\"\n");
  folder.write(job_file, job.replace(begin, name.size(), "machine.toml"));
}

}  // namespace retrace::test
