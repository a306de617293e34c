#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/refusals.h"

#include "tests/app/program.h"

// Tests of tools/run in environments in which it cannot do its work. It must print one line with the remedy and must
// not leave partial results. The environment consists of stubs, which are the only programs that the script can find.

namespace retrace::test::tools_test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDebian12 = "PRETTY_NAME='Debian GNU/Linux 12 (bookworm)'\nID=debian\nVERSION_ID='12'\n";

class ToolsRun : public ::testing::Test {
 protected:
  void SetUp() override {
    const fs::path source = RETRACE_SOURCE_DIR;
    fs::create_directories(project() / "tools/lib");
    for (const char* name :
         {"CMakeLists.txt", "CMakePresets.json", "tools/run", "tools/packages.txt", "tools/lib/setup.sh"})
      fs::copy_file(source / name, project() / name);
    fs::create_directory(stubs());
    for (const char* name : {"bash", "cat", "cksum", "dirname", "grep", "readlink", "rm", "rmdir", "sed", "sort"})
      fs::create_symlink(fs::exists(fs::path("/bin") / name) ? fs::path("/bin") / name : fs::path("/usr/bin") / name,
                         stubs() / name);
    stub("id", "echo 0");
    stub("env", "shift; exec \"$@\"");  // the program follows `env DEBIAN_FRONTEND=...`
    stub("dpkg-query", "exit 1");       // no package is installed
    stub("apt-get", "echo \"apt-get $1\" >>../asked; echo 'E: Failed to fetch' >&2; exit 100");
    stub("cmake", "[ \"$1\" = --version ] && { echo cmake version 3.25.1; exit; }; mkdir -p build/release; exit 1");
    fs::create_symlink("/bin/mkdir", stubs() / "mkdir");
    folder_.write("os-release", kDebian12);
  }

  fs::path project() const { return folder_.path() / "project"; }
  fs::path stubs() const { return folder_.path() / "stubs"; }
  void stub(const std::string& name, const std::string& script) const {
    folder_.write("stubs/" + name, "#!/bin/sh\n" + script + "\n");
    fs::permissions(stubs() / name, fs::perms::owner_all);
  }
  Outcome run(const Arguments& arguments = {}) const {
    return Child(project(),
                 with({"/usr/bin/env", "-i", "PATH=" + stubs().string(),
                       "RETRACE_OS_RELEASE=" + (folder_.path() / "os-release").string(), "bash", "tools/run"},
                      arguments))
        .wait();
  }
  /// Returns the arguments of all calls of apt-get, one call per line.
  std::string asked() const { return fs::exists(folder_.path() / "asked") ? folder_.read("asked") : ""; }
  /// Expects that tools/run ended with exit code 3 and did not create a build folder. Messages of tools/run itself
  /// begin with "run: ". There must be exactly `others` + 1 of them on standard error, including its last line.
  /// \param named name of a command, version or system that the last line must contain
  /// \return the last line of standard error
  std::string expect_gives_up(const Outcome& outcome, const std::string& named = "", std::ptrdiff_t others = 0) const {
    EXPECT_EQ(outcome.code, 3) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    const std::vector<std::string> lines = lines_of(outcome.err);
    if (lines.empty()) {
      ADD_FAILURE() << "nothing on standard error";
      return "";
    }
    EXPECT_NE(lines.back().find(named), std::string::npos) << outcome.err;
    EXPECT_TRUE(lines.back().starts_with("run: ")) << outcome.err;
    record_message(lines.back());
    EXPECT_EQ(std::count_if(lines.begin(), lines.end(), [](const auto& line) { return line.starts_with("run: "); }),
              others + 1)
        << outcome.err;
    EXPECT_FALSE(fs::exists(project() / "build"));
    return lines.back();
  }

  TemporaryFolder folder_;
};

TEST_F(ToolsRun, WithoutNetworkItSaysSo) {
  const Outcome outcome = run();
  EXPECT_EQ(outcome.code, 3);
  record_message(lines_of(outcome.err).back());
  EXPECT_FALSE(fs::exists(project() / "build"));
  EXPECT_NE(asked(), "");
}

TEST_F(ToolsRun, WithoutTheRightToInstallItSaysWhatToAskFor) {
  const std::string install = " apt-get install --no-install-recommends g++ ";
  stub("id", "echo 1000");
  const std::string without_sudo = expect_gives_up(run(), install);
  EXPECT_EQ(without_sudo.find("sudo" + install), std::string::npos);
  stub("sudo", "exit 1");
  expect_gives_up(run(), "sudo" + install);
  const std::string not_allowed = expect_gives_up(run({"--no-install"}), install);
  EXPECT_EQ(not_allowed.find("sudo" + install), std::string::npos);
  EXPECT_NE(not_allowed, without_sudo);
  EXPECT_EQ(asked(), "");
}

TEST_F(ToolsRun, AnOldCMakeIsRefusedBeforeAnythingIsInstalled) {
  stub("cmake", "echo cmake version 3.18.4");
  expect_gives_up(run(), " 3.18.4,");
  stub("cmake", "exit 1");
  expect_gives_up(run(), " 3.25 ");
  EXPECT_EQ(asked(), "");
}

TEST_F(ToolsRun, AnOldDebianIsRefusedBeforeAnythingIsInstalled) {
  folder_.write("os-release", "PRETTY_NAME='Debian GNU/Linux 11 (bullseye)'\nID=debian\nVERSION_ID='11'\n");
  expect_gives_up(run(), "Debian GNU/Linux 11 (bullseye)");
  EXPECT_EQ(asked(), "");
}

TEST_F(ToolsRun, ElsewhereNothingIsInstalledAndWhatLacksIsToldInTheEnd) {
  for (const char* system : {"PRETTY_NAME='Ubuntu 22.04.4 LTS'\nID=ubuntu\nVERSION_ID='22.04'\n",
                             "PRETTY_NAME='Fedora Linux 40'\nID=fedora\nVERSION_ID=40\n", ""}) {
    folder_.write("os-release", system);
    expect_gives_up(run(), "docs/dependencies.md", 2);
  }
  fs::remove(stubs() / "dpkg-query");
  expect_gives_up(run(), "docs/dependencies.md", 2);
  EXPECT_EQ(asked(), "");
}

TEST(PackageList, IsWhatTheDebianPackageIsBuiltWith) {
  const std::vector<std::string> control = lines_of(read_text(fs::path(RETRACE_SOURCE_DIR) / "debian/control"));
  const std::vector<std::string> list = lines_of(read_text(fs::path(RETRACE_SOURCE_DIR) / "tools/packages.txt"));
  const auto begin = std::find(list.begin(), list.end(), "[run]");
  const auto end = std::find_if(begin + 1, list.end(), [](const std::string& line) { return line.starts_with("["); });
  ASSERT_GT(end - begin, 20);
  for (auto line = begin + 1; line != end; ++line) {
    const std::string package = line->substr(0, line->find(' '));
    // Every environment that builds Debian packages contains the compiler. mpirun is not needed to build the package.
    if (package.empty() || package == "g++" || package == "openmpi-bin") continue;
    EXPECT_TRUE(std::any_of(control.begin(), control.end(),
                            [&](const std::string& wanted) {
                              return wanted.starts_with(" " + package + ",") ||
                                     wanted.starts_with(" " + package + " (");
                            }))
        << "debian/control builds without " << package;
  }
}

}  // namespace
}  // namespace retrace::test::tools_test
