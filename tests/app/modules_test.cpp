#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/app/program.h"

// Tests of a program without its modules, or without the libraries that the modules need.

namespace retrace::test::modules_test {
namespace {

namespace fs = std::filesystem;

/// A command that needs a module, and the path at which the program searches for the module.
struct Need {
  std::string module;
  std::string command;
  std::string package;
};

const std::vector<Need>& needs() {
  static const std::vector<Need> all = {{"retrace_step", "export d.toml part.step", "libocct-data-exchange-7.6"},
                                        {"retrace_pictures", "image d.toml --detector -o out", "libopenimageio2.4"},
                                        {"retrace_mpi", "roughness d.toml -o out", "openmpi-bin"}};
  return all;
}

/// Fixture with a copy of the program in bin/ and its data, but without modules.
class Modules : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"bin", "share", "lib/retrace"}) fs::create_directories(folder_.path() / name);
    std::error_code error;
    fs::create_hard_link(RETRACE_PROGRAM, folder_.path() / "bin/retrace", error);
    if (error) fs::copy_file(RETRACE_PROGRAM, folder_.path() / "bin/retrace");
    fs::create_directory_symlink(fs::path(RETRACE_SOURCE_DIR) / "data", folder_.path() / "share/retrace");
    folder_.write("d.toml", read_text(example("rtp_single_0p45mm.toml")));
  }
  Outcome run(const std::string& command) const {
    return Child(folder_.path(), {"/bin/sh", "-c", "OMPI_COMM_WORLD_SIZE=2 exec bin/retrace " + command}).wait();
  }

  TemporaryFolder folder_;
};

TEST_F(Modules, WithoutOneTheMessageSaysWhatTheBuildLeftOut) {
  for (const Need& need : needs()) {
    const Outcome outcome = run(need.command);
    EXPECT_EQ(refused_at(outcome, 3), "");
    EXPECT_NE(outcome.err.find(need.module), std::string::npos) << outcome.err;
  }
}

TEST_F(Modules, WithoutItsLibraryTheMessageNamesTheDebianPackage) {
  for (const Need& need : needs()) {
    folder_.write("lib/retrace/" + need.module + ".so", "not a library\n");
    const Outcome outcome = run(need.command);
    EXPECT_EQ(refused_at(outcome, 3), "");
    EXPECT_NE(outcome.err.find(" package " + need.package + ","), std::string::npos) << outcome.err;
  }
  EXPECT_FALSE(fs::exists(folder_.path() / "out"));
}

TEST_F(Modules, WithoutTheReaderOfStepFilesTheMessageNamesIt) {
  folder_.write("lens.step", "ISO-10303-21;\nEND-ISO-10303-21;\n");
  folder_.write("s.toml", read_text(example("rtp_single_0p45mm.toml")) +
                              "\n[entrance_surface]\nkind = \"step\"\nfile = \"lens.step\"\n");
  const Outcome outcome = run("inspect s.toml");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("retrace_step_reader"), std::string::npos) << outcome.err;
}

TEST_F(Modules, TheProgramItselfNeedsNoneOfTheirLibraries) {
  const std::string program = read_text(RETRACE_PROGRAM);
  for (const char* library : {"libmpi", "libTKernel", "libOpenImageIO"})
    EXPECT_EQ(program.find(std::string(library) + ".so"), std::string::npos) << library;
}

}  // namespace
}  // namespace retrace::test::modules_test
