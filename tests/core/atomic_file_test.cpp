#include "core/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <optional>
#include <set>

#include "core/error.h"
#include "tests/support/refusals.h"

// The tests may run as root, for whom permissions have no effect. Failures are therefore caused by other means.

namespace retrace::atomic_file_test {
namespace {

namespace fs = std::filesystem;

class AtomicFile : public ::testing::Test {
 protected:
  AtomicFile() {
    std::string name = (fs::temp_directory_path() / "retrace_core_XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  ~AtomicFile() override { fs::remove_all(folder_); }

  std::set<std::string> names() const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_)) names.insert(entry.path().filename());
    return names;
  }

  static std::string complaint(const fs::path& path, std::string_view content) {
    try {
      write_file_atomically(path, content);
      return {};
    } catch (const OutputError& error) {
      return recorded_place_of(error);
    }
  }

  fs::path folder_;
};

/// Limits the size of files to `bytes` during its lifetime. This simulates a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  void (*handler_)(int);
  rlimit before_{};
};

TEST_F(AtomicFile, WritesAndReplacesAndLeavesNothingElse) {
  const fs::path file = folder_ / "a.txt";
  write_file_atomically(file, "first, and longer");
  EXPECT_EQ(read_file(file), "first, and longer");
  write_file_atomically(file, std::string("second\0\n", 8));
  EXPECT_EQ(read_file(file), std::string("second\0\n", 8));
  EXPECT_EQ(names(), std::set<std::string>{"a.txt"});
}

TEST_F(AtomicFile, FailureHalfWayLeavesTheOldFileAsItWas) {
  const fs::path file = folder_ / "a.txt";
  write_file_atomically(file, "old");
  std::optional<OutputError> error;
  {
    const FileSizeLimit limit(1000);
    try {
      write_file_atomically(file, std::string(5000, 'x'));
    } catch (const OutputError& thrown) {
      error = thrown;
    }
  }
  ASSERT_TRUE(error);
  EXPECT_EQ(recorded_place_of(*error), "failed");
  EXPECT_EQ(read_file(file), "old");
  EXPECT_EQ(names(), std::set<std::string>{"a.txt"}) << "no half file may stay";
}

TEST_F(AtomicFile, FolderInTheWayOrMissingIsRefused) {
  fs::create_directory(folder_ / "a.txt");
  EXPECT_EQ(complaint(folder_ / "a.txt", "x"), "failed");
  EXPECT_EQ(complaint(folder_ / "no/b.txt", "x"), "failed");
  EXPECT_EQ(names(), std::set<std::string>{"a.txt"});
}

TEST_F(AtomicFile, DevicesAreWrittenThrough) {
  EXPECT_EQ(complaint("/dev/null", "x"), "");
  EXPECT_EQ(complaint("/dev/full", "x"), "failed");
  EXPECT_TRUE(fs::is_character_file("/dev/null")) << "the device must not be replaced by a file";
}

TEST_F(AtomicFile, SymbolicLinkStaysAndWhatItPointsToIsReplaced) {
  write_file_atomically(folder_ / "target", "old");
  fs::create_symlink("target", folder_ / "link");
  write_file_atomically(folder_ / "link", "new");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_EQ(read_file(folder_ / "target"), "new");
}

/// Returns the permission bits of a file.
int mode_of(const fs::path& file) {
  return static_cast<int>(fs::status(file).permissions());
}

TEST_F(AtomicFile, AReplacedFileKeepsItsMode) {
  const fs::path file = folder_ / "a.txt";
  for (const int mode : {0600, 0640, 0644, 0666, 0755, 0400}) {
    write_file_atomically(file, "first");
    fs::permissions(file, fs::perms(mode));
    write_file_atomically(file, "second");
    EXPECT_EQ(mode_of(file), mode);
    AtomicFileWriter growing(file);
    growing.append("third");
    for (const auto& entry : fs::directory_iterator(folder_))
      EXPECT_EQ(mode_of(entry.path()) & ~mode, 0) << "the content is readable for others before it has its name";
    growing.finish();
    EXPECT_EQ(mode_of(file), mode);
    EXPECT_EQ(read_file(file), "third");
    fs::remove(file);
  }
  const mode_t before = ::umask(027);
  write_file_atomically(file, "new");
  ::umask(before);
  EXPECT_EQ(mode_of(file), 0640) << "the umask limits the mode of a new file";
}

TEST_F(AtomicFile, NoPlantedFileIsFollowedOverwrittenOrRemoved) {
  const fs::path victim = folder_ / "victim";
  write_file_atomically(victim, "precious");
  // Create files with names that an attacker could guess for the temporary file: with the process id, or in the format
  // of temporary names.
  const std::string by_process = ".a.txt." + std::to_string(::getpid()) + ".tmp";
  fs::create_symlink("victim", folder_ / by_process);
  fs::create_symlink("victim", folder_ / ".a.txt.0123456789abcdef.tmp");
  ASSERT_EQ(::mkfifo((folder_ / ".a.txt.0123456789abcdee.tmp").c_str(), 0600), 0);
  write_file_atomically(folder_ / ".a.txt.notes.tmp", "of the user");
  const std::set<std::string> planted = names();
  write_file_atomically(folder_ / "a.txt", "content");
  std::set<std::string> expected = planted;
  expected.insert("a.txt");
  EXPECT_EQ(names(), expected);
  EXPECT_EQ(read_file(victim), "precious");
  EXPECT_FALSE(fs::is_symlink(folder_ / "a.txt"));
  EXPECT_EQ(read_file(folder_ / "a.txt"), "content");
}

TEST_F(AtomicFile, WritersOfOneFileDoNotMixAndTheLastOneWins) {
  // Processes in different containers may have the same process id. Two files that are open in this process simulate
  // this case.
  const fs::path file = folder_ / "a.txt";
  AtomicFileWriter first(file);
  first.append("first");
  AtomicFileWriter second(file);
  second.append("second, longer");
  write_file_atomically(file, "third");
  EXPECT_EQ(read_file(file), "third");
  first.finish();
  EXPECT_EQ(read_file(file), "first");
  second.finish();
  EXPECT_EQ(read_file(file), "second, longer");
  EXPECT_EQ(names(), std::set<std::string>{"a.txt"});
}

TEST_F(AtomicFile, WhatAKilledProcessLeftIsRemovedByTheNextRun) {
  const fs::path file = folder_ / "a.txt";
  write_file_atomically(folder_ / "b.txt", "another output");
  for (int k = 0; k < 3; ++k) {
    const pid_t child = ::fork();
    if (child == 0) {
      AtomicFileWriter growing(file);
      growing.append(std::string(1 << 20, 'x'));
      ::kill(::getpid(), SIGKILL);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(names().size(), 2U) << "the killed process leaves its file and removes that of the one before";
  }
  write_file_atomically(folder_ / "b.txt", "only removes what belongs to it");
  EXPECT_EQ(names().size(), 2U);
  write_file_atomically(file, "content");
  EXPECT_EQ(names(), (std::set<std::string>{"a.txt", "b.txt"}));
}

TEST_F(AtomicFile, OutputFolderIsMadeWithItsParents) {
  make_output_folder(folder_ / "a/b/c");
  EXPECT_TRUE(fs::is_directory(folder_ / "a/b/c"));
  make_output_folder(folder_ / "a/b/c");
  make_output_folder(folder_ / "d/");
  EXPECT_TRUE(fs::is_directory(folder_ / "d"));
}

TEST_F(AtomicFile, OutputFolderBehindAFileIsRefused) {
  write_file_atomically(folder_ / "file", "x");
  EXPECT_THROW(make_output_folder(folder_ / "file"), OutputError);
  EXPECT_THROW(make_output_folder(folder_ / "file/below"), OutputError);
  EXPECT_EQ(read_file(folder_ / "file"), "x");
}

TEST_F(AtomicFile, OnlyFilesAreRead) {
  EXPECT_THROW(read_file(folder_), InputError);
  EXPECT_THROW(read_file(folder_ / "missing"), InputError);
  write_file_atomically(folder_ / "empty", "");
  EXPECT_EQ(read_file(folder_ / "empty"), "");
}

TEST_F(AtomicFile, AGrowingFileAppearsWhenItIsFinished) {
  const fs::path file = folder_ / "file";
  write_file_atomically(file, "before");
  {
    AtomicFileWriter growing(file);
    growing.append("head");
    for (int k = 0; k < 100'000; ++k) growing.append("0123456789");
    growing.overwrite(0, "HE");
    growing.append("tail");
    EXPECT_EQ(read_file(file), "before");
    growing.finish();
  }
  const std::string text = read_file(file);
  EXPECT_EQ(text.size(), 1'000'008U);
  EXPECT_TRUE(text.starts_with("HEad0123456789"));
  EXPECT_TRUE(text.ends_with("789tail"));
  EXPECT_EQ(names(), std::set<std::string>{"file"});
}

TEST_F(AtomicFile, NothingIsLeftOfAGrowingFileThatIsNotFinished) {
  const fs::path file = folder_ / "file";
  write_file_atomically(file, "before");
  AtomicFileWriter(file).append(std::string(1 << 20, 'x'));
  EXPECT_EQ(read_file(file), "before");
  EXPECT_EQ(names(), std::set<std::string>{"file"});
  EXPECT_THROW(AtomicFileWriter("/dev/null"), OutputError);
  EXPECT_THROW(AtomicFileWriter(folder_ / "no" / "file"), OutputError);
  const FileSizeLimit limit(1000);
  AtomicFileWriter growing(folder_ / "full");
  growing.append(std::string(2000, 'x'));
  EXPECT_THROW(growing.finish(), OutputError);
}

/// Returns the message of the error for a file that is refused, or an empty text if the file is accepted.
std::string complaint_of(const fs::path& file, std::size_t most_bytes) {
  return refusal_of([&] { read_file(file, most_bytes); });
}

TEST_F(AtomicFile, NoMoreIsReadThanAFileMayHave) {
  const fs::path file = folder_ / "file";
  for (const std::size_t most : {std::size_t{1}, std::size_t{1000}, (std::size_t{1} << 20) + 7}) {
    write_file_atomically(file, std::string(most, 'x'));
    EXPECT_EQ(read_file(file, most).size(), most);
    write_file_atomically(file, std::string(most + 1, 'x'));
    EXPECT_EQ(complaint_of(file, most), "TMP/file");
  }
}

TEST_F(AtomicFile, OnlyRegularFilesAreRead) {
  const fs::path pipe = folder_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string file : {"/dev/zero", "/dev/null"}) EXPECT_EQ(complaint_of(file, 1000), file);
  EXPECT_EQ(complaint_of(pipe, 1000), "TMP/pipe");
}

TEST_F(AtomicFile, LibrariesAreGivenShortFilesOnly) {
  write_file_atomically(folder_ / "file", "1234");
  EXPECT_NO_THROW(require_short_file(folder_ / "file", 4));
  EXPECT_NO_THROW(require_short_file(folder_ / "missing", 4));
  EXPECT_THROW(require_short_file(folder_ / "file", 3), InputError);
  EXPECT_THROW(require_short_file(folder_, 4), InputError);
  EXPECT_THROW(require_short_file("/dev/zero", 4), InputError);
}

}  // namespace
}  // namespace retrace::atomic_file_test
