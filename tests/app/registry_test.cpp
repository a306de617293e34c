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

  /// Returns the completions of the last word of each line. One process of the shell completes all lines, because the
  /// start of an interactive shell takes a second.
  std::vector<Arguments> completed(const Arguments& lines) const {
    Arguments run = {"/usr/bin/env", GetParam(), ".ask"};
    if (GetParam() == "zsh") run.insert(run.begin() + 2, "-f");
    const Outcome outcome = Child(folder_.path(), with(run, lines)).wait(patient(60));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    std::vector<Arguments> found(1);
    for (std::string text : lines_of(outcome.out)) {
      if (text.ends_with('\r')) text.pop_back();
      if (text == "next line")
        found.emplace_back();
      else if (text.starts_with('<') && text.ends_with('>'))
        found.back().push_back(text.substr(1, text.size() - 2));
    }
    found.pop_back();
    EXPECT_EQ(found.size(), lines.size()) << outcome.out;
    found.resize(lines.size());
    for (Arguments& words : found) {
      std::sort(words.begin(), words.end());
      words.erase(std::unique(words.begin(), words.end()), words.end());
    }
    return found;
  }

  TemporaryFolder folder_;

 private:
  // Splits each line into words like bash: at spaces and at "=".
  static constexpr const char* kAskBash = R"(source ./.script
for asked in "$@"; do
  line=${asked//=/ = }
  read -ra COMP_WORDS <<<"$line"
  [[ $line != *' ' ]] || COMP_WORDS+=('')
  COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
  COMPREPLY=()
  _retrace
  ((${#COMPREPLY[@]} == 0)) || printf '<%s>\n' "${COMPREPLY[@]%/}"
  echo 'next line'
done
)";
  static constexpr const char* kAskFish = R"(source ./.script
for asked in $argv
    for line in (complete -C "$asked")
        echo '<'(string replace -r '/?(\t.*)?$' '' -- $line)'>'
    end
    echo 'next line'
end
)";
  // Runs an interactive shell in a pseudo-terminal. The function compadd is replaced by one that prints the
  // completions. Control-U deletes the preceding line.
  static constexpr const char* kAskZsh = R"(zmodload zsh/zpty
zpty shell zsh -f -i
zpty -w shell 'source ./.init'
zpty -r -m shell said '*ready*'
for line in "$@"; do
  zpty -w -n shell $'\C-u'"$line"$'\t'
  zpty -r -m shell said '*<end>*'
  print -r -- "${said//<end>/}"
  print -r -- 'next line'
done
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
finish() {
  print -r -- "" "<end>"
  comppostfuncs=(finish)
}
comppostfuncs=(finish)
bindkey '^I' complete-word
print -r -- "rea""dy"
)";
};

TEST_P(Completion, KnowsEveryCommandAndOption) {
  const TemporaryFolder folder;
  const Json manual = retrace_json(folder, {"manual"});
  Arguments lines = {"retrace "};
  for (const Json& command : manual["commands"]) lines.push_back("retrace " + std::string(command["name"]) + " --");
  const std::vector<Arguments> answers = completed(lines);
  const Arguments& found = answers[0];
  EXPECT_EQ(found.size(), manual["commands"].size());
  for (std::size_t k = 0; k < manual["commands"].size(); ++k) {
    const Json& command = manual["commands"][k];
    const std::string name = command["name"];
    EXPECT_TRUE(std::find(found.begin(), found.end(), name) != found.end()) << name;
    const Arguments& options = answers[k + 1];
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
  struct Question {
    std::string line;
    Arguments words;  ///< sorted
    bool are_all;     ///< true if these words are all completions, false if there may be others
  };
  const std::vector<Question> questions = {
      {"retrace rre a.toml --engine ", {"auto", "cell", "embree", "exact", "montecarlo", "stochastic"}, true},
      {"retrace image a.toml --engine ", {"auto", "embree", "exact", "montecarlo"}, true},
      {"retrace job a.toml --machine ", {"a.toml", "ideal-dmc"}, false},
      {"retrace photometry a.toml --standard ", {"b.csv", "j594"}, false},
      {"retrace photometry a.toml --colour ", {"amber"}, false},
      {"retrace verify a.toml c.txt --dialect ", {"auto"}, false},
      {"retrace metrology c.txt --form pl", {"plane"}, true},
      {"retrace rre --set body.th", {"body.thickness_mm="}, true},
      {"retrace rre --set ", {"surface.root_radius_um="}, false},
      {"retrace list ", {"machines", "materials", "processes", "requests", "standards"}, true},
      // `list` is a file here.
      {"retrace --json list schema ",
       {"cubes", "design", "job", "machine", "materials", "planed_part", "process", "study", "turned_part"},
       true},
      {"retrace report ", {"results"}, true},
      {"retrace rre a.toml -o ", {"results"}, true},
      {"retrace rre ", {"a.toml"}, false},
      {"retrace verify a.toml ", {"c.txt"}, false},
      {"retrace rre a.toml --samples ", {}, true}};
  Arguments lines;
  for (const Question& question : questions) lines.push_back(question.line);
  const std::vector<Arguments> answers = completed(lines);
  for (std::size_t k = 0; k < questions.size(); ++k) {
    const auto& [line, words, are_all] = questions[k];
    if (are_all)
      EXPECT_EQ(answers[k], words) << line;
    else
      EXPECT_TRUE(std::ranges::includes(answers[k], words)) << line;
  }
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
