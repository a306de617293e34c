#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "tests/app/program.h"

// Every command that README.md and docs/*.md show is run as it stands there, in a folder that looks like the project's:
// tools/run and retrace are the program, examples/ is the project's. Results such as build/... land in that folder.

namespace retrace::test::readme_test {
namespace {

namespace fs = std::filesystem;

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

bool starts_with_word(const std::string& text, const std::string& word) {
  return text == word || text.starts_with(word + " ");
}

/// A line of a code block without its comment.
std::string command_in(const std::string& line) {
  if (line.starts_with("#")) return "";
  return trimmed(line.substr(0, line.find(" #")));
}

/// The commands of a page: lines of sh blocks, and indented lines with retrace that are no synopsis.
std::vector<std::string> commands_of(const std::string& page) {
  std::vector<std::string> commands;
  bool in_block = false;
  bool in_shell = false;
  std::string begun;  // of a command that goes on in the next line
  for (const std::string& line : lines_of(page)) {
    if (trimmed(line).starts_with("```")) {
      in_shell = !in_block && trimmed(line) == "```sh";
      in_block = !in_block;
      continue;
    }
    const bool is_indented = !in_block && line.starts_with("    retrace ") && line.find('[') == std::string::npos;
    if (!in_shell && !is_indented) continue;
    std::string command = begun + command_in(line);
    begun.clear();
    if (command.ends_with('\\'))
      begun = command.substr(0, command.size() - 1);
    else if (!command.empty())
      commands.push_back(command);
  }
  return commands;
}

bool is_run(const std::string& command) {
  return (starts_with_word(command, "tools/run") && command != "tools/run") || starts_with_word(command, "retrace");
}

/// What builds, tests or installs is not run from within a test.
bool is_known(const std::string& command) {
  for (const char* word : {"tools/run", "tools/test", "tools/package", "tools/try_packages", "cmake", "apt-get", "podman"})
    if (starts_with_word(command, word)) return true;
  return starts_with_word(command, "retrace");
}

/// A command that reads examples/ alone and writes to a folder named by its last word, as in `... -o my_result`.
struct Example {
  std::string question;  ///< what stands between the program and that name
  std::string output;
};

/// A file that a page's own commands have written, such as my_job.toml.
bool is_own_file(const std::string& word) {
  const std::size_t point = word.rfind('.');
  return point != std::string::npos && point + 1 < word.size() && std::isalpha(word[point + 1]) != 0 &&
         word.find('=') == std::string::npos && !word.starts_with("examples/");
}

std::optional<Example> example_of(const std::string& command) {
  std::istringstream text(command);
  const std::vector<std::string> words{std::istream_iterator<std::string>(text), {}};
  if (words.size() < 4 || words[words.size() - 2] != "-o") return {};
  if (std::none_of(words.begin(), words.end(), [](const auto& word) { return word.starts_with("examples/"); }))
    return {};
  if (std::any_of(words.begin(), words.end(), is_own_file)) return {};
  Example example{"", words.back()};
  for (std::size_t k = 1; k + 2 < words.size(); ++k) example.question += words[k] + " ";
  return example;
}

/// What examples have written on pages before, by their question: README.md and docs/ show some of them both.
class Written {
 public:
  /// Puts what it wrote into `folder`. \return false if it has not been run
  bool give(const Example& example, const fs::path& folder) const {
    const fs::path kept = of(example.question);
    if (kept.empty()) return false;
    fs::copy(kept, folder / example.output, fs::copy_options::recursive | fs::copy_options::overwrite_existing);
    return true;
  }
  void keep(const Example& example, const fs::path& folder) {
    kept_.push_back(example.question);
    fs::copy(folder / example.output, of(example.question), fs::copy_options::recursive);
  }

 private:
  fs::path of(const std::string& question) const {
    const auto found = std::find(kept_.begin(), kept_.end(), question);
    return found == kept_.end() ? fs::path() : folder_.path() / std::to_string(found - kept_.begin());
  }

  TemporaryFolder folder_;
  std::vector<std::string> kept_;
};

/// Runs the commands of a page one after another, as a reader would. \param written what needs not be run again
/// \return how many commands the page shows
int run_page(const fs::path& page, Written& written) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "tools");
  fs::create_directory(folder.path() / "build");
  fs::create_directory_symlink(fs::path(RETRACE_SOURCE_DIR) / "examples", folder.path() / "examples");
  fs::create_symlink(RETRACE_PROGRAM, folder.path() / "tools/run");
  fs::create_symlink(RETRACE_PROGRAM, folder.path() / "tools/retrace");
  int count = 0;
  for (const std::string& command : commands_of(read_text(page))) {
    SCOPED_TRACE(page.filename().string() + ": " + command);
    EXPECT_TRUE(is_known(command)) << "what is this command?";
    if (!is_run(command)) continue;
    ++count;
    const std::optional<Example> example = example_of(command);
    if (example && written.give(*example, folder.path())) continue;
    const Outcome outcome = Child(folder.path(), {"/bin/sh", "-c", "PATH=\"$PWD/tools:$PATH\"; " + command}).wait();
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    if (example && outcome.code == 0) written.keep(*example, folder.path());
  }
  return count;
}

TEST(Readme, CommandsOfReadmeAndDocumentationRun) {
  Written written;
  EXPECT_GE(run_page(fs::path(RETRACE_SOURCE_DIR) / "README.md", written), 3);
  int count = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(RETRACE_SOURCE_DIR) / "docs"))
    if (entry.path().extension() == ".md") count += run_page(entry.path(), written);
  EXPECT_GE(count, 1);
}

TEST(Readme, ExamplesThatDifferByTheNameOfTheirOutputAreOne) {
  const auto question = [](const std::string& command) { return example_of(command).value_or(Example{}).question; };
  EXPECT_EQ(question("tools/run sweep examples/a.toml --x -o my_table"), "sweep examples/a.toml --x ");
  EXPECT_EQ(question("retrace sweep examples/a.toml --x -o table1"), "sweep examples/a.toml --x ");
  EXPECT_EQ(question("retrace rre d.toml -o result"), "") << "reads what a page wrote before";
  EXPECT_EQ(question("retrace fabricate my_job.toml --machine examples/m.toml -o a"), "") << "the same";
  EXPECT_EQ(question("retrace job examples/a.toml -o job.toml"), "") << "writes a file, not a folder";
  EXPECT_EQ(question("retrace rre examples/a.toml"), "") << "writes no folder";
}

TEST(Readme, CommandsAreFoundAndCommentsLeftOut) {
  EXPECT_EQ(commands_of("text\n```sh\ntools/run a \\\nb   # why\n# a comment\n```\n```json\nx\n```\n"
                        "    retrace rre d.toml\n    retrace rre DESIGN... [options]\n"),
            (std::vector<std::string>{"tools/run a b", "retrace rre d.toml"}));
}

}  // namespace
}  // namespace retrace::test::readme_test
