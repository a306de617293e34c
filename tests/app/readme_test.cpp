#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

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
  for (const char* word : {"tools/run", "tools/test", "cmake", "apt-get"})
    if (starts_with_word(command, word)) return true;
  return starts_with_word(command, "retrace");
}

/// Runs the commands of a page one after another, as a reader would. \return how many
int run_page(const fs::path& page) {
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
    const Outcome outcome = Child(folder.path(), {"/bin/sh", "-c", "PATH=\"$PWD/tools:$PATH\"; " + command}).wait();
    EXPECT_EQ(outcome.code, 0) << outcome.err;
  }
  return count;
}

TEST(Readme, ItsCommandsRun) {
  EXPECT_GE(run_page(fs::path(RETRACE_SOURCE_DIR) / "README.md"), 3);
}

TEST(Readme, CommandsOfTheDocumentationRun) {
  int count = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(RETRACE_SOURCE_DIR) / "docs"))
    if (entry.path().extension() == ".md") count += run_page(entry.path());
  EXPECT_GE(count, 1);
}

TEST(Readme, CommandsAreFoundAndCommentsLeftOut) {
  EXPECT_EQ(commands_of("text\n```sh\ntools/run a \\\nb   # why\n# a comment\n```\n```json\nx\n```\n"
                        "    retrace rre d.toml\n    retrace rre DESIGN... [options]\n"),
            (std::vector<std::string>{"tools/run a b", "retrace rre d.toml"}));
}

}  // namespace
}  // namespace retrace::test::readme_test
