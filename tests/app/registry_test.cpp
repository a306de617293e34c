#include <gtest/gtest.h>

#include <algorithm>

#include "tests/app/program.h"

// Tests that every command of the program is in its help, its manual, the table in docs/commands.md and the completion
// of each shell. Every command must also have a page in docs/commands/. The tests run the completion scripts in their
// shells.

namespace retrace::test::registry_test {
namespace {

/// Fixture that runs the completion script of a shell in a folder with a few files.
class Completion : public testing::TestWithParam<std::string> {
 protected:
  Completion() {
    for (const char* name : {"a.toml", "b.csv", "c.txt", "results/r.json"}) {
      std::filesystem::create_directories((folder_.path() / name).parent_path());
      folder_.write(name, "");
    }
    const Outcome outcome = retrace(folder_, {"completion", GetParam()});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    folder_.write(".script", outcome.out);
    folder_.write(".ask", GetParam() == "bash" ? kAskBash : GetParam() == "zsh" ? kAskZsh : kAskFish);
    folder_.write(".init", kZshInit);
  }

  /// Returns the completions of the last word of a line.
  Arguments completed(const std::string& line) const {
    Arguments run = {"/usr/bin/env", GetParam(), ".ask", line};
    if (GetParam() == "zsh") run.insert(run.begin() + 2, "-f");
    const Outcome outcome = Child(folder_.path(), run).wait(patient(60));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    Arguments found;
    for (std::string text : lines_of(outcome.out)) {
      if (text.ends_with('\r')) text.pop_back();
      if (text.starts_with('<') && text.ends_with('>')) found.push_back(text.substr(1, text.size() - 2));
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }

  bool offers(const std::string& line, const std::string& word) const {
    const Arguments found = completed(line);
    return std::find(found.begin(), found.end(), word) != found.end();
  }

  TemporaryFolder folder_;

 private:
  // Splits the line into words like bash: at spaces and at "=".
  static constexpr const char* kAskBash = R"(source ./.script
line=${1//=/ = }
read -ra COMP_WORDS <<<"$line"
[[ $line != *' ' ]] || COMP_WORDS+=('')
COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
_retrace
((${#COMPREPLY[@]} == 0)) || printf '<%s>\n' "${COMPREPLY[@]%/}"
)";
  static constexpr const char* kAskFish = R"(source ./.script
for line in (complete -C "$argv[1]")
    echo '<'(string replace -r '/?(\t.*)?$' '' -- $line)'>'
end
)";
  // Runs an interactive shell in a pseudo-terminal. The function compadd is replaced by one that prints the
  // completions.
  static constexpr const char* kAskZsh = R"(zmodload zsh/zpty
zpty shell zsh -f -i
zpty -w shell 'source ./.init'
zpty -r -m shell said '*ready*'
zpty -w -n shell "$1"$'\t'
zpty -r -m shell said '*<end>*'
print -r -- "${said//<end>/}"
)";
  static constexpr const char* kZshInit = R"(PROMPT=
autoload -Uz compinit
compinit -D -u
source ./.script
compadd() {
  local -a hits
  [[ ${@[1,(i)(-|--)]} == *-(O|A|D)\ * ]] || builtin compadd -A hits "$@"
  (( ! $#hits )) || print -rl -- "" "<"$^hits">"
  builtin compadd "$@"
}
finish() { print -r -- "" "<end>" }
comppostfuncs=(finish)
bindkey '^I' complete-word
print -r -- "rea""dy"
)";
};

TEST_P(Completion, KnowsEveryCommandAndOption) {
  const TemporaryFolder folder;
  const Json manual = retrace_json(folder, {"manual"});
  const Arguments found = completed("retrace ");
  EXPECT_EQ(found.size(), manual["commands"].size());
  for (const Json& command : manual["commands"]) {
    const std::string name = command["name"];
    EXPECT_TRUE(std::find(found.begin(), found.end(), name) != found.end()) << name;
    if (GetParam() == "zsh" && name.size() > 3) continue;  // zsh takes a second for each name
    const Arguments options = completed("retrace " + name + " --");
    for (const Json& arguments : {command["arguments"], manual["arguments"]})
      for (const Json& argument : arguments)
        for (const std::string option : argument["names"]) {
          const auto is_it = [&](const std::string& one) { return one == option || one == option + "="; };
          EXPECT_TRUE(!option.starts_with("--") || std::any_of(options.begin(), options.end(), is_it))
              << name << option;
        }
  }
}

TEST_P(Completion, KnowsWhatMayStandForAValue) {
  EXPECT_EQ(completed("retrace rre a.toml --engine "),
            (Arguments{"auto", "cell", "embree", "exact", "montecarlo", "stochastic"}));
  EXPECT_EQ(completed("retrace image a.toml --engine "), (Arguments{"auto", "embree", "exact", "montecarlo"}));
  EXPECT_TRUE(offers("retrace job a.toml --machine ", "ideal-dmc"));
  EXPECT_TRUE(offers("retrace job a.toml --machine ", "a.toml"));
  EXPECT_TRUE(offers("retrace photometry a.toml --standard ", "j594"));
  EXPECT_TRUE(offers("retrace photometry a.toml --standard ", "b.csv"));
  EXPECT_TRUE(offers("retrace photometry a.toml --colour ", "amber"));
  EXPECT_TRUE(offers("retrace verify a.toml c.txt --dialect ", "auto"));
  EXPECT_EQ(completed("retrace metrology c.txt --form pl"), Arguments{"plane"});
  EXPECT_EQ(completed("retrace rre --set body.th"), Arguments{"body.thickness_mm="});
  EXPECT_TRUE(offers("retrace rre --set ", "surface.root_radius_um="));
  EXPECT_EQ(completed("retrace list "), (Arguments{"machines", "materials", "processes", "requests", "standards"}));
  EXPECT_EQ(completed("retrace --json list schema "),
            (Arguments{"design", "job", "machine", "materials", "planed_part", "process", "study", "turned_part"}))
      << "list is a file here";
  EXPECT_EQ(completed("retrace report "), Arguments{"results"});
  EXPECT_EQ(completed("retrace rre a.toml -o "), Arguments{"results"});
  EXPECT_TRUE(offers("retrace rre ", "a.toml"));
  EXPECT_TRUE(offers("retrace verify a.toml ", "c.txt"));
  EXPECT_EQ(completed("retrace rre a.toml --samples "), Arguments{});
}

INSTANTIATE_TEST_SUITE_P(Shells, Completion, testing::Values("bash", "zsh", "fish"),
                         [](const auto& instance) { return instance.param; });

TEST(Completions, OfBashOffersFilesWithTheirEndingAlone) {
  const TemporaryFolder folder;
  folder.write("a.toml", "");
  folder.write("c.txt", "");
  folder.write("script", retrace(folder, {"completion", "bash"}).out);
  const std::string ask =
      "source ./script; COMP_WORDS=(retrace rre --engine = ex); COMP_CWORD=4; _retrace; echo \"${COMPREPLY[@]}\"; "
      "COMP_WORDS=(retrace rre ''); COMP_CWORD=2; _retrace; echo \"${COMPREPLY[@]}\"";
  EXPECT_EQ(Child(folder.path(), {"/bin/bash", "-c", ask}).wait().out, "exact\na.toml\n");
  const Outcome lint = Child(folder.path(), {"/usr/bin/env", "shellcheck", "script"}).wait();
  EXPECT_EQ(lint.out + lint.err, "");
}

TEST(Completions, RefuseOtherShells) {
  const TemporaryFolder folder;
  const Outcome outcome = retrace(folder, {"completion", "csh"});
  EXPECT_EQ(refused_at(outcome), "completion");
}

TEST(Manual, HasEveryCommandAndOptionAndIsWellFormed) {
  const TemporaryFolder folder;
  const Json manual = retrace_json(folder, {"manual"});
  const std::string page = retrace(folder, {"manual", "-o", "retrace.1"}).code == 0 ? folder.read("retrace.1") : "";
  EXPECT_EQ(manual["text"], page);
  std::string plain = page;
  plain.erase(std::remove(plain.begin(), plain.end(), '\\'), plain.end());
  const std::string help = retrace(folder, {"--help"}).out;
  for (const Json& command : manual["commands"]) {
    const std::string name = command["name"];
    const std::string summary = command["summary"];
    const std::string synopsis = command["synopsis"];
    EXPECT_NE(plain.find(".SS \"" + synopsis + "\""), std::string::npos) << name;
    EXPECT_NE(help.find("\n  " + name + std::string(32 - name.size(), ' ') + summary + "\n"), std::string::npos)
        << name;
    const std::string its_help = retrace(folder, {name, "--help"}).out;
    for (const Json& argument : command["arguments"])
      for (const std::string option : argument["names"]) {
        EXPECT_NE(its_help.find("  " + option + " "), std::string::npos) << name << option;
        EXPECT_NE(plain.find("fB" + option + "fR"), std::string::npos) << name << option;
      }
  }
  // The manual page has no date, because it contains the version instead.
  const std::string lint = "mandoc -T lint -W warning retrace.1 2>&1 | grep -v 'missing date'";
  EXPECT_EQ(Child(folder.path(), {"/bin/sh", "-c", lint}).wait().out, "");
}

/// Returns a page of docs/.
std::string documentation(const std::string& page) {
  return read_text(std::string(RETRACE_SOURCE_DIR) + "/docs/" + page);
}

/// Returns the text between two marks in docs/commands.md.
std::string listed() {
  const std::string page = documentation("commands.md");
  const std::string mark = "<!-- commands -->\n";
  const std::size_t first = page.find(mark) + mark.size();
  return page.substr(first, page.find("<!-- end -->", first) - first);
}

void expect_options_on(const std::string& page, const Json& arguments) {
  for (const Json& argument : arguments)
    for (const std::string option : argument["names"]) EXPECT_NE(page.find("`" + option), std::string::npos) << option;
}

TEST(Documentation, ListsTheCommands) {
  const TemporaryFolder folder;
  const Json manual = retrace_json(folder, {"manual"});
  std::string expected = "\n| command | arguments | does |\n|---|---|---|\n";
  for (const Json& command : manual["commands"]) {
    const std::string name = command["name"];
    std::string arguments = command["synopsis"].get<std::string>().substr(("retrace " + name + " ").size());
    // A bar would begin the next column of the table.
    for (std::size_t at = arguments.find('|'); at != std::string::npos; at = arguments.find('|', at + 2))
      arguments.insert(at, 1, '\\');
    expected += "| [" + name + "](commands/" + name + ".md) | `" + arguments + "` | " +
                command["summary"].get<std::string>() + " |\n";
  }
  EXPECT_EQ(listed(), expected + "\n");
  expect_options_on(documentation("commands.md"), manual["arguments"]);
}

TEST(Documentation, HasAPageWithAllOptionsOfEachCommand) {
  const TemporaryFolder folder;
  const Json manual = retrace_json(folder, {"manual"});
  for (const Json& command : manual["commands"]) {
    const std::string name = command["name"];
    SCOPED_TRACE(name);
    const std::string page = documentation("commands/" + name + ".md");
    EXPECT_TRUE(page.starts_with("# retrace " + name + "\n"));
    EXPECT_NE(page.find("\n    " + command["synopsis"].get<std::string>() + "\n"), std::string::npos);
    expect_options_on(page, command["arguments"]);
  }
}

// Runs several fast commands. The registry must contain the formats that they write.
TEST(Registry, NamesTheFormatsThatAreWritten) {
  const TemporaryFolder folder;
  const Json manual = retrace_json(folder, {"manual"});
  const std::string design = example("rtp_single_0p45mm.toml");
  for (const Arguments& run :
       {Arguments{"rre", design, "--samples=64"}, Arguments{"inspect", design}, Arguments{"export", design},
        Arguments{"job", design, "--tool-width-mm=0.2"}, Arguments{"init", "rtp"}, Arguments{"list", "standards"},
        Arguments{"schema"}, Arguments{"manual"}, Arguments{"completion", "fish"},
        Arguments{"metrology", example("facet_height_map.txt")}}) {
    const auto& all = manual["commands"];
    const auto command = std::find_if(all.begin(), all.end(), [&](const Json& c) { return c["name"] == run.front(); });
    const Json& writes = (*command)["writes"];
    const std::string schema = retrace_json(folder, run)["schema"];
    EXPECT_TRUE(std::find(writes.begin(), writes.end(), schema) != writes.end()) << run.front() << " " << schema;
  }
}

}  // namespace
}  // namespace retrace::test::registry_test
