#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/app/program.h"

// Runs every command that README.md, docs/*.md, docs/commands/*.md and docs/tutorials/*.md show, exactly as the page
// shows it. Each page is a separate test, so that pages run in parallel. A test runs in a temporary folder with the
// layout of the project. In this folder, tools/run and retrace are the program, and examples/ is a link to the
// examples. Tests of tutorials also write the files that the tutorial asks the reader to save. They compare the output
// that a tutorial shows with the output of the program.

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

/// Returns a line of a code block without its comment.
std::string command_in(const std::string& line) {
  if (line.starts_with("#")) return "";
  return trimmed(line.substr(0, line.find(" #")));
}

/// A step of a page: a command, a file to save, or a line of output that the page shows.
struct Step {
  enum Kind { kCommand, kFile, kShown };
  Kind kind = kCommand;
  std::string text;  ///< the command, the content of the file, or the line of output
  std::string name;  ///< name of the file
  // Expected exit code of a command, from its comment "# exit code 1".
  int code = 0;
};

int code_in(const std::string& line) {
  const std::string mark = "# exit code ";
  const std::size_t at = line.find(mark);
  return at == std::string::npos ? 0 : std::stoi(line.substr(at + mark.size()));
}

/// Adds the steps of a code block. A block whose first line is "# my_NAME.ENDING" is a file to save. The lines of a
/// `text` block are expected output.
void add_block(const std::string& kind, const std::vector<std::string>& lines, std::vector<Step>& steps) {
  const bool is_file = !lines.empty() && lines.front().starts_with("# my_") && kind != "sh" && kind != "text";
  if (is_file) {
    Step file{Step::kFile, "", lines.front().substr(2)};
    for (const std::string& line : lines) file.text += line + "\n";
    steps.push_back(file);
  }
  if (kind == "text")
    for (const std::string& line : lines)
      if (line != "...") steps.push_back({Step::kShown, line, ""});
  if (kind != "sh") return;
  std::string begun;  // beginning of a command that continues on the next line
  for (const std::string& line : lines) {
    std::string command = begun + command_in(line);
    begun.clear();
    if (command.ends_with('\\'))
      begun = command.substr(0, command.size() - 1);
    else if (!command.empty())
      steps.push_back({Step::kCommand, command, "", code_in(line)});
  }
}

/// Returns the steps of a page, from its code blocks and from indented lines with `retrace`. Lines that show a synopsis
/// are skipped.
std::vector<Step> steps_of(const std::string& page) {
  std::vector<Step> steps;
  std::optional<std::string> kind;  // kind of the current block
  std::vector<std::string> block;
  for (const std::string& line : lines_of(page)) {
    if (trimmed(line).starts_with("```")) {
      if (kind) add_block(*kind, block, steps);
      kind = kind ? std::nullopt : std::optional(trimmed(line).substr(3));
      block.clear();
    } else if (kind) {
      block.push_back(line);
    } else if (line.starts_with("    retrace ") && line.find('[') == std::string::npos) {
      add_block("sh", {line}, steps);
    }
  }
  return steps;
}

std::vector<std::string> commands_of(const std::string& page) {
  std::vector<std::string> commands;
  for (const Step& step : steps_of(page))
    if (step.kind == Step::kCommand) commands.push_back(step.text);
  return commands;
}

bool is_run(const std::string& command) {
  return (starts_with_word(command, "tools/run") && command != "tools/run") || starts_with_word(command, "retrace");
}

/// Returns true if the command is known. Tests do not run the known commands that build, test or install.
bool is_known(const std::string& command) {
  for (const char* word :
       {"tools/run", "tools/test", "tools/package", "tools/try_packages", "cmake", "apt-get", "podman"})
    if (starts_with_word(command, word)) return true;
  return starts_with_word(command, "retrace");
}

/// A command that reads only examples/ and writes to the folder that its last word names, as in `... -o my_result`.
struct Example {
  std::string question;  ///< words between the name of the program and `-o`
  std::string output;
};

/// Returns true if the word is a file that commands of the page have written, such as my_job.toml.
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

/// Output folders of examples that have been run, found by their command. A page may show the same example twice.
class Written {
 public:
  /// Copies the output of an example into `folder`.
  /// \return false if the example has not been run
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

void make_like_the_project(const TemporaryFolder& folder) {
  fs::create_directory(folder.path() / "tools");
  fs::create_directory(folder.path() / "build");
  fs::create_directory_symlink(fs::path(RETRACE_SOURCE_DIR) / "examples", folder.path() / "examples");
  fs::create_symlink(RETRACE_PROGRAM, folder.path() / "tools/run");
  fs::create_symlink(RETRACE_PROGRAM, folder.path() / "tools/retrace");
}

Outcome run_in(const TemporaryFolder& folder, const std::string& command) {
  return Child(folder.path(), {"/bin/sh", "-c", "PATH=\"$PWD/tools:$PATH\"; " + command}).wait();
}

/// Returns README.md and the pages of docs/ and docs/commands/, in the order of their paths. The pages of
/// docs/commands/ come before docs/commands.md.
std::vector<fs::path> pages() {
  std::vector<fs::path> found;
  for (const char* folder : {"docs", "docs/commands"})
    for (const auto& entry : fs::directory_iterator(fs::path(RETRACE_SOURCE_DIR) / folder))
      if (entry.path().extension() == ".md") found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  found.insert(found.begin(), fs::path(RETRACE_SOURCE_DIR) / "README.md");
  return found;
}

/// Returns the examples on the pages before `page`, as commands without the name of their output. The tests of those
/// pages run these examples.
std::set<std::string> questions_before(const fs::path& page) {
  std::set<std::string> questions;
  for (const fs::path& earlier : pages()) {
    if (earlier == page) break;
    for (const std::string& command : commands_of(read_text(earlier)))
      if (const std::optional<Example> example = example_of(command)) questions.insert(example->question);
  }
  return questions;
}

/// Returns true if a command after the command number `at` contains the name of the output folder of the example.
bool is_read_later(const std::vector<std::string>& commands, std::size_t at, const Example& example) {
  return std::any_of(commands.begin() + static_cast<std::ptrdiff_t>(at) + 1, commands.end(),
                     [&](const std::string& later) { return later.find(example.output) != std::string::npos; });
}

/// Runs the commands of a page in order, as a reader would. Examples that an earlier page shows are skipped unless a
/// later command reads their output.
/// \return number of commands on the page
int run_page(const fs::path& page) {
  const TemporaryFolder folder;
  make_like_the_project(folder);
  const std::set<std::string> run_elsewhere = questions_before(page);
  const std::vector<std::string> commands = commands_of(read_text(page));
  Written written;
  int count = 0;
  for (std::size_t at = 0; at < commands.size(); ++at) {
    const std::string& command = commands[at];
    SCOPED_TRACE(page.filename().string() + ": " + command);
    if (!is_run(command)) continue;
    ++count;
    const std::optional<Example> example = example_of(command);
    if (example && run_elsewhere.contains(example->question) && !is_read_later(commands, at, *example)) continue;
    if (example && written.give(*example, folder.path())) continue;
    const Outcome outcome = run_in(folder, command);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    if (example && outcome.code == 0) written.keep(*example, folder.path());
  }
  return count;
}

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream text(line);
  return {std::istream_iterator<std::string>(text), {}};
}

/// Returns true if two words are equal, or are numbers within 2 % or 0.02 of each other. Numbers may differ because the
/// random rays depend on the instruction set.
bool is_like(const std::string& shown, const std::string& printed) {
  if (shown == printed) return true;
  const auto number = [](const std::string& word, double& value) {
    char* end = nullptr;
    value = std::strtod(word.c_str(), &end);
    return !word.empty() && *end == '\0';
  };
  double a = 0.0;
  double b = 0.0;
  return number(shown, a) && number(printed, b) &&
         std::abs(a - b) <= std::max(0.02, 0.02 * std::max(std::abs(a), std::abs(b)));
}

bool is_line_like(const std::string& shown, const std::string& printed) {
  return std::ranges::equal(words_of(shown), words_of(printed), is_like);
}

/// Executes all steps of a tutorial. Each line of output that the tutorial shows must occur in the output of the
/// commands that ran after the previously shown lines.
void follow(const fs::path& page) {
  const TemporaryFolder folder;
  make_like_the_project(folder);
  std::vector<std::string> printed;
  std::size_t at = 0;
  bool has_shown = false;
  for (const Step& step : steps_of(read_text(page))) {
    SCOPED_TRACE(page.filename().string() + ": " + step.text);
    if (step.kind == Step::kFile) {
      folder.write(step.name, step.text);
    } else if (step.kind == Step::kCommand) {
      if (has_shown) printed.clear();
      if (has_shown) at = 0;
      has_shown = false;
      const Outcome outcome = run_in(folder, step.text);
      EXPECT_EQ(outcome.code, step.code) << outcome.out << outcome.err;
      for (const std::string& line : lines_of(outcome.out + outcome.err)) printed.push_back(line);
    } else {
      has_shown = true;
      std::size_t found = at;
      while (found < printed.size() && !is_line_like(step.text, printed[found])) ++found;
      EXPECT_LT(found, printed.size()) << "the program does not print this";
      if (found < printed.size()) at = found + 1;
    }
  }
}

/// Sets the environment so that the mpirun commands of a tutorial work in any test environment.
void let_mpirun_run_here() {
  for (const char* name :
       {"OMPI_ALLOW_RUN_AS_ROOT", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "OMPI_MCA_rmaps_base_oversubscribe"})
    ::setenv(name, "1", 1);
  ::setenv("OMPI_MCA_plm", "isolated", 1);
  ::setenv("OMPI_MCA_hwloc_base_binding_policy", "none", 1);
  // Ignore memory leaks of Open MPI.
  ::setenv("ASAN_OPTIONS", "detect_leaks=0", 1);
}

class Tutorials : public testing::TestWithParam<std::string> {};

TEST_P(Tutorials, DoAsTheySay) {
  if (GetParam() == "cluster") let_mpirun_run_here();
  follow(fs::path(RETRACE_SOURCE_DIR) / "docs/tutorials" / (GetParam() + ".md"));
}

std::string name_of(const testing::TestParamInfo<std::string>& tutorial) {
  return tutorial.param;
}

// ctest runs every tutorial as a separate test (register_tests.py).
INSTANTIATE_TEST_SUITE_P(Docs, Tutorials,
                         testing::Values("first_curve", "lamp", "measured_facet", "nc_program", "test_cuts", "ranging",
                                         "regulation", "sheeting", "step_lens", "cluster"),
                         name_of);

TEST(TutorialPages, AreAllFollowed) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(fs::path(RETRACE_SOURCE_DIR) / "docs/tutorials"))
    names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{"cluster", "first_curve", "lamp", "measured_facet", "nc_program",
                                             "ranging", "regulation", "sheeting", "step_lens", "test_cuts"}));
}

TEST(TutorialPages, AreReadStepByStep) {
  const std::vector<Step> steps = steps_of(
      "Save this:\n```toml\n# my_a.toml\nx = 1\n```\n```toml\nshown = 1\n```\n```sh\nretrace a b  # exit code 1\n```\n"
      "```text\n  a  1\n...\nb\n```\n");
  ASSERT_EQ(steps.size(), 4u);
  EXPECT_EQ(steps[0].name, "my_a.toml");
  EXPECT_EQ(steps[0].text, "# my_a.toml\nx = 1\n");
  EXPECT_EQ(steps[1].text, "retrace a b");
  EXPECT_EQ(steps[1].code, 1);
  EXPECT_EQ(steps[3].text, "b");
  EXPECT_TRUE(is_line_like("a 99.0 b", "  a   99.9  b"));
  EXPECT_FALSE(is_line_like("a 99.0 b", "a 95.0 b"));
  EXPECT_FALSE(is_line_like("a 1", "a 1 2"));
}

/// Returns the anchor of a heading, as GitHub and mkdocs form it.
std::string anchor_of(const std::string& heading) {
  std::string anchor;
  for (const char c : trimmed(heading)) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-')
      anchor += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    else if (c == ' ')
      anchor += '-';
  }
  return anchor;
}

/// Returns the lines that are not in a fenced block.
std::vector<std::string> prose_of(const fs::path& page) {
  std::vector<std::string> prose;
  bool in_block = false;
  for (const std::string& line : lines_of(read_text(page))) {
    if (trimmed(line).starts_with("```"))
      in_block = !in_block;
    else if (!in_block)
      prose.push_back(line);
  }
  return prose;
}

bool has_anchor(const fs::path& page, const std::string& anchor) {
  return std::ranges::any_of(prose_of(page), [&](const std::string& line) {
    return line.starts_with("#") && anchor_of(line.substr(line.find_first_not_of('#'))) == anchor;
  });
}

TEST(Documentation, LinksLeadSomewhere) {
  const fs::path root = RETRACE_SOURCE_DIR;
  std::vector<fs::path> pages = {root / "README.md", root / "CONVENTIONS.md", root / "CONTRIBUTING.md",
                                 root / "CHANGELOG.md"};
  for (const auto& entry : fs::recursive_directory_iterator(root / "docs"))
    if (entry.path().extension() == ".md") pages.push_back(entry.path());
  const std::regex link(R"(\]\(([^()\s]+)\))");
  int count = 0;
  for (const fs::path& page : pages)
    for (const std::string& line : prose_of(page))
      for (std::sregex_iterator found(line.begin(), line.end(), link), end; found != end; ++found) {
        const std::string target = (*found)[1];
        if (target.find("://") != std::string::npos) continue;
        const std::string path = target.substr(0, target.find('#'));
        const fs::path goal = path.empty() ? page : page.parent_path() / path;
        EXPECT_TRUE(fs::exists(goal)) << page << ": " << target;
        const std::string anchor = target.substr(path.size() == target.size() ? target.size() : path.size() + 1);
        const bool has_one = target.find('#') != std::string::npos && fs::exists(goal);
        EXPECT_TRUE(!has_one || has_anchor(goal, anchor)) << page << ": " << target;
        ++count;
      }
  EXPECT_GE(count, 100);
}

/// Names of the pages that show commands, in the order of `pages()`.
const std::vector<std::string> kPagesWithCommands = {
    "README",  "calibrate", "explore", "export",    "fabricate", "forces",      "image",      "init",
    "inspect", "job",       "list",    "manual",    "metrology", "optimize",    "photometry", "plane",
    "ranging", "rays",      "report",  "roughness", "rre",       "schema",      "sweep",      "tolerance",
    "turn",    "validate",  "verify",  "commands",  "gallery",   "planing_file"};

class Pages : public testing::TestWithParam<std::string> {};

TEST_P(Pages, CommandsRun) {
  const std::vector<fs::path> all = pages();
  const auto page = std::ranges::find(all, GetParam(), [](const fs::path& path) { return path.stem().string(); });
  ASSERT_NE(page, all.end());
  EXPECT_GE(run_page(*page), 1);
}

// ctest runs every page as a separate test (register_tests.py).
INSTANTIATE_TEST_SUITE_P(Docs, Pages, testing::ValuesIn(kPagesWithCommands), name_of);

TEST(Readme, PagesWithCommandsAreAllRun) {
  std::vector<std::string> names;
  for (const fs::path& page : pages())
    if (std::ranges::any_of(commands_of(read_text(page)), is_run)) names.push_back(page.stem().string());
  EXPECT_EQ(names, kPagesWithCommands);
}

TEST(Readme, CommandsOfAllPagesAreKnown) {
  for (const fs::path& page : pages())
    for (const std::string& command : commands_of(read_text(page)))
      EXPECT_TRUE(is_known(command)) << page << ": " << command;
}

TEST(Readme, ExamplesOfEarlierPagesAreNotRunAgain) {
  const fs::path docs = fs::path(RETRACE_SOURCE_DIR) / "docs";
  EXPECT_TRUE(questions_before(pages().front()).empty());
  EXPECT_GE(questions_before(docs / "gallery.md").size(), 5u);
  const std::vector<std::string> commands = {"retrace rre examples/a.toml -o a", "retrace report a"};
  EXPECT_TRUE(is_read_later(commands, 0, *example_of(commands[0])));
  EXPECT_FALSE(is_read_later({commands[0]}, 0, *example_of(commands[0])));
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
