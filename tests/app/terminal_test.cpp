// Tests that texts and file names cannot control the terminal or add lines to the output, whatever characters they
// contain.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "core/message_text.h"
#include "tests/app/program.h"

namespace retrace::test::terminal_test {
namespace {

/// File name with control sequences that clear the screen, set the title of the terminal and add a line.
const std::string kHostile =
    "a\x1b[2J\x1b]0;t\x07\r\nverdict: pass\x7f\xc2\x9b"
    "1m";

/// Returns the text as a TOML string, with escaped control characters.
std::string in_toml(const std::string& text) {
  std::string toml = "\"";
  for (std::size_t k = 0; k < text.size(); ++k) {
    const auto byte = static_cast<unsigned char>(text[k]);
    if (byte == 0xc2) {
      toml += "\\u00" + std::string(text[++k] == '\x9b' ? "9B" : "80");
    } else if (byte < 0x20 || byte == 0x7f) {
      constexpr std::string_view digits = "0123456789ABCDEF";
      toml += std::string("\\u00") + digits[byte >> 4] + digits[byte & 0xf];
    } else {
      toml += text[k];
    }
  }
  return toml + "\"";
}

/// Runs commands on a design, a machine, files and folders that all have the name `name`, and counts the lines that
/// each command prints.
class Session {
 public:
  explicit Session(const std::string& name) : name_(name) {
    const std::string title = "title = " + in_toml(name) + "\n";
    folder_.write("design.toml", title +
                                     "[element]\nkind = \"rtp\"\nbase_mm = 1\nwidth_mm = 1\n[array]\nx_length_mm = 2\n"
                                     "y_length_mm = 2\n[body]\nthickness_mm = 1\nrefractive_index = 1.5\n");
    folder_.write(name_ + ".toml", folder_.read("design.toml"));
    std::string machine = read_text(std::string(RETRACE_SOURCE_DIR) + "/data/machines/thesis.toml");
    const std::size_t begin = machine.find("name = \"");
    const std::size_t end = machine.find('\n', begin);
    folder_.write("machine.toml", machine.replace(begin, end - begin, "name = " + in_toml(name)));
  }

  void run(Arguments arguments, const std::vector<int>& codes = {0}) {
    for (std::string& argument : arguments)
      if (const std::size_t at = argument.find("NAME"); at != std::string::npos) argument.replace(at, 4, name_);
    const Outcome outcome = retrace(folder_, arguments);
    EXPECT_NE(std::ranges::find(codes, outcome.code), codes.end()) << arguments[0] << ": " << outcome.err;
    for (const std::string& text : {outcome.out, outcome.err})
      EXPECT_EQ(text, printable_lines(text)) << arguments[0] << " prints control characters";
    commands.push_back(arguments[0]);
    lines.push_back(std::ranges::count(outcome.out, '\n'));
  }

  void run_all() {
    run({"export", "design.toml", "NAME.stl"});
    run({"export", "NAME.toml", "-o", "part.obj"});
    run({"inspect", "NAME.toml", "-o", "NAME"});
    run({"rre", "NAME.toml", "design.toml", "--engine", "exact", "-o", "NAME"});
    run({"photometry", "NAME.toml", "--standard", "r150", "--class", "IA", "--colour", "white", "--area-cm2", "30",
         "--no-advice", "-o", "NAME"},
        {0, 1});
    run({"rays", "NAME.toml", "--emitter", "collimated", "--rays", "100", "-o", "NAME.csv"});
    run({"report", "NAME"});
    run({"explore", "NAME.toml", "-o", "NAME.html"});
    run({"job", "NAME.toml", "--machine", "machine.toml", "--tool-width-mm", "1", "-o", "NAME job.toml"});
    run({"fabricate", "NAME job.toml", "-o", "NAME"});
    std::filesystem::copy_file(folder_.path() / name_ / "program.ngc", folder_.path() / (name_ + ".ngc"));
    run({"verify", "NAME job.toml", "NAME.ngc", "-o", "NAME"}, {0, 1});
    folder_.write(name_ + ".ngc", folder_.read(name_ + ".ngc").substr(0, 2000));  // with findings
    run({"verify", "NAME job.toml", "NAME.ngc"}, {0, 1, 2});
    run({"forces", "NAME job.toml", "-o", "NAME"});
    for (const std::string kind : {"planing/zone_lens_60ghz", "turning/cylinder_lens"}) {
      folder_.write(name_ + " part.toml", read_text(example(kind + ".toml")));
      run({kind.starts_with("turning") ? "turn" : "plane", "NAME part.toml", "-o", "NAME"});
    }
    folder_.write(name_ + ".txt", read_text(example("facet_height_map.txt")));
    run({"metrology", "NAME.txt", "-o", "NAME"});
    run({"inspect", "NAME missing.toml"}, {2});
    run({"rre", "NAME.toml", "-o", "NAME.toml"}, {2, 3});
  }

  std::vector<std::string> commands;  ///< names of the commands, in the order in which they ran
  std::vector<std::ptrdiff_t> lines;  ///< number of lines that each command printed

 private:
  TemporaryFolder folder_;
  std::string name_;
};

TEST(Terminal, NamesOfFilesNeitherCommandItNorAddLines) {
  Session plain("plain");
  plain.run_all();
  Session hostile(kHostile);
  hostile.run_all();
  ASSERT_EQ(plain.commands, hostile.commands);
  for (std::size_t k = 0; k < plain.lines.size(); ++k)
    EXPECT_EQ(hostile.lines[k], plain.lines[k]) << plain.commands[k] << ", run " << k;
}

TEST(Terminal, ATextThatIsAFileIsPrintedByteForByte) {
  const TemporaryFolder folder;
  folder.write("d.toml",
               "title = \"tab\\u007F\"\n[element]\nkind = \"rtp\"\nbase_mm = 1\nwidth_mm = 1\n[array]\n"
               "x_length_mm = 2\ny_length_mm = 2\n[body]\nthickness_mm = 1\n");
  for (const Arguments& arguments :
       {Arguments{"explore", "d.toml"}, Arguments{"job", "d.toml", "--machine", "thesis", "--tool-width-mm", "1"}}) {
    const Outcome printed = retrace(folder, arguments);
    ASSERT_EQ(printed.code, 0) << printed.err;
    EXPECT_EQ(retrace(folder, with(arguments, {"-o", "file", "--quiet"})).code, 0);
    EXPECT_EQ(printed.out, folder.read("file")) << arguments[0];
    EXPECT_EQ(retrace(folder, with(arguments, {"--quiet"})).out, printed.out) << arguments[0];
  }
}

}  // namespace
}  // namespace retrace::test::terminal_test
