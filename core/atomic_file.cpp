#include "core/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <fstream>
#include <iostream>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "core/temporary_files.h"

namespace retrace {
namespace fs = std::filesystem;
namespace {

std::string reason(int error_number) {
  return std::generic_category().message(error_number);
}

/// Number of random bytes in the name of a temporary file.
constexpr std::size_t kRandomBytes = 8;

/// Returns the prefix of the names of temporary files for the output file `target`. A complete name consists of this
/// prefix, kRandomBytes random bytes in hexadecimal, and kTemporarySuffix.
std::string temporary_prefix(const fs::path& target) {
  return "." + target.filename().string() + ".";
}
constexpr std::string_view kTemporarySuffix = ".tmp";

bool is_temporary_name(const std::string& name, const std::string& prefix) {
  if (name.size() != prefix.size() + 2 * kRandomBytes + kTemporarySuffix.size()) return false;
  const auto is_hex = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
  return name.starts_with(prefix) && name.ends_with(kTemporarySuffix) &&
         std::ranges::all_of(std::string_view(name).substr(prefix.size(), 2 * kRandomBytes), is_hex);
}

/// Removes a temporary file unless a process is still writing it. The writing process holds a lock (flock) on the
/// file. The operating system releases this lock when the process ends.
void remove_if_abandoned(const fs::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return;
  struct stat status = {};
  const bool is_regular = ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
  if (is_regular && ::flock(descriptor, LOCK_EX | LOCK_NB) == 0) ::unlink(file.c_str());
  ::close(descriptor);
}

/// Removes the temporary files that earlier processes left in the folder of `target` because they were killed while
/// writing `target`.
void remove_abandoned(const fs::path& target) {
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  const std::string prefix = temporary_prefix(target);
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (is_temporary_name(entry->path().filename().string(), prefix)) remove_if_abandoned(entry->path());
}

/// Name of a temporary file in an array of fixed size. A signal handler can read it without locks and without
/// allocation.
struct TemporaryName {
  std::atomic<bool> is_taken{false};  ///< true if a KnownName object uses this entry
  std::atomic<bool> is_set{false};    ///< true if `name` is complete
  std::array<char, 4096> name{};
};
/// Maximum number of temporary files that a signal handler can remove when it ends the process. If more files are open
/// at that time, the additional files remain until a later run writes the same output files.
constexpr std::size_t kMaxTemporaryNames = 16;
std::array<TemporaryName, kMaxTemporaryNames> temporary_names;

/// Registers the name of a temporary file in `temporary_names`, until clear() is called or the object is destroyed.
class KnownName {
 public:
  KnownName() = default;
  KnownName(const KnownName&) = delete;
  KnownName& operator=(const KnownName&) = delete;
  ~KnownName() { clear(); }

  void set(const fs::path& file) {
    clear();
    const std::string& name = file.native();
    for (TemporaryName& entry : temporary_names) {
      if (name.size() >= entry.name.size() || entry.is_taken.exchange(true)) continue;
      std::copy(name.begin(), name.end(), entry.name.begin());
      entry.name[name.size()] = '\0';
      entry.is_set.store(true);
      entry_ = &entry;
      return;
    }
  }
  void clear() {
    if (entry_ == nullptr) return;
    entry_->is_set.store(false);
    entry_->is_taken.store(false);
    entry_ = nullptr;
  }

 private:
  TemporaryName* entry_ = nullptr;  ///< entry in `temporary_names`; null if no name is registered
};

/// A new file with a random temporary name. move_to() renames it to its final name. If move_to() is not called, the
/// destructor removes the file. Existing files are never opened, because other users may have placed files or links in
/// the folder.
class TemporaryFile {
 public:
  explicit TemporaryFile(const fs::path& target) {
    remove_abandoned(target);
    struct stat before = {};
    const bool is_replacement = ::stat(target.c_str(), &before) == 0;
    const mode_t mode = is_replacement ? before.st_mode & 0777 : 0666;
    make(target, mode);
    // The umask limits the mode of a new file. A file that replaces an existing file gets the mode of the existing
    // file. A failure of fchmod is ignored because some file systems do not store modes.
    if (is_replacement) static_cast<void>(::fchmod(descriptor_, mode));
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() { discard(); }

  void write(std::string_view content, const fs::path& target) {
    while (!content.empty()) {
      const ssize_t written = ::write(descriptor_, content.data(), content.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail(target);
      content.remove_prefix(static_cast<std::size_t>(written));
    }
  }

  void go_to(off_t offset, int whence, const fs::path& target) const {
    if (::lseek(descriptor_, offset, whence) < 0) fail(target);
  }

  void move_to(const fs::path& target) {
    if (::fsync(descriptor_) != 0 && errno != EINVAL) fail(target);
    // The file is renamed before it is closed, because closing releases the lock. Without the lock, another process
    // could remove the temporary file as abandoned.
    if (::rename(name_.c_str(), target.c_str()) != 0) fail(target);
    known_name_.clear();
    name_.clear();
    if (::close(std::exchange(descriptor_, -1)) != 0) fail(target);
  }

 private:
  [[noreturn]] static void fail(const fs::path& target) {
    throw OutputError(fmt::format("{}: cannot be written: {}", target.string(), reason(errno)));
  }

  /// Creates and locks a new file. If another process removes the file before it is locked, the function creates
  /// another file.
  void make(const fs::path& target, mode_t mode) {
    constexpr int kMaxAttempts = 100;
    for (int attempt = 0; attempt < kMaxAttempts; ++attempt) {
      name_ = target.parent_path() / random_name(target);
      descriptor_ = ::open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode);
      if (descriptor_ < 0 && errno == EEXIST) continue;
      if (descriptor_ < 0) fail(target);
      known_name_.set(name_);
      // A failure of flock is ignored because some network file systems do not support locks. On these file systems,
      // abandoned files are never removed.
      static_cast<void>(::flock(descriptor_, LOCK_EX));
      struct stat made = {};
      if (::fstat(descriptor_, &made) == 0 && made.st_nlink > 0) return;
      ::close(std::exchange(descriptor_, -1));
    }
    errno = EEXIST;
    fail(target);
  }

  static std::string random_name(const fs::path& target) {
    std::array<unsigned char, kRandomBytes> bytes{};
    if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) fail(target);
    return fmt::format("{}{:02x}{}", temporary_prefix(target), fmt::join(bytes, ""), kTemporarySuffix);
  }

  void discard() {
    if (descriptor_ < 0) return;
    if (!name_.empty()) ::unlink(name_.c_str());
    known_name_.clear();
    ::close(std::exchange(descriptor_, -1));
  }

  fs::path name_;  ///< temporary name; empty after move_to()
  KnownName known_name_;
  int descriptor_ = -1;
};

/// Returns the target of a symbolic link. A file that is written to this target replaces the target and not the link.
/// Any other path is returned unchanged.
/// \throw OutputError if the target cannot be determined, for example because links form a cycle
fs::path followed(const fs::path& path) {
  std::error_code error;
  if (!fs::is_symlink(path, error)) return path;
  const fs::path target = fs::read_symlink(path, error);
  const fs::path found = error ? fs::path() : fs::weakly_canonical(path.parent_path() / target, error);
  if (error) throw OutputError(fmt::format("{}: cannot be written: {}", path.string(), error.message()));
  return found;
}

[[noreturn]] void refuse_unreadable(const fs::path& path, const std::string& why) {
  throw InputError(InputLocation{path.string(), 0, ""}, "cannot be read: " + why);
}

[[noreturn]] void refuse_long(const std::string& name, std::size_t max_bytes) {
  throw InputError(InputLocation{name, 0, ""}, fmt::format("must have at most {} bytes, but is larger", max_bytes));
}

/// Reads a stream to its end. Stops after `max_bytes` + 1 bytes, because the stream may be infinite.
/// \param name name of the stream in messages
/// \throw InputError if the stream has more than `max_bytes` bytes or cannot be read
std::string read_all(std::istream& stream, const std::string& name, std::size_t max_bytes) {
  constexpr std::size_t kPieceBytes = std::size_t{1} << 20;
  std::string text;
  while (stream && text.size() <= max_bytes) {
    const std::size_t before = text.size();
    text.resize(before + std::min(kPieceBytes, max_bytes + 1 - before));
    stream.read(text.data() + before, static_cast<std::streamsize>(text.size() - before));
    text.resize(before + static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) refuse_unreadable(name, "read error");
  require_short_text(text, name, max_bytes);
  return text;
}

}  // namespace

void remove_temporary_files() noexcept {
  for (const TemporaryName& entry : temporary_names)
    if (entry.is_set.load()) ::unlink(entry.name.data());
}

void write_file_atomically(const fs::path& path, std::string_view content) {
  std::error_code ignored;
  if (fs::exists(path, ignored) && !fs::is_regular_file(path, ignored)) {
    // Devices such as /dev/null and pipes cannot be replaced by a regular file. The content is written directly to
    // them.
    if (fs::is_directory(path, ignored)) throw OutputError(path.string() + ": cannot be written: it is a folder");
    std::ofstream stream(path, std::ios::binary);
    stream << content << std::flush;
    if (!stream) throw OutputError(path.string() + ": cannot be written");
    return;
  }
  const fs::path target = followed(path);
  TemporaryFile file(target);
  file.write(content, target);
  file.move_to(target);
}

/// Implementation of AtomicFileWriter. Appended bytes are collected in a buffer, because many calls of append() add
/// only a few bytes.
class AtomicFileWriter::Impl {
 public:
  explicit Impl(fs::path target) : target_(std::move(target)), file_(target_) {}

  void append(std::string_view bytes) {
    constexpr std::size_t kGathered = std::size_t{1} << 18;
    gathered_ += bytes;
    if (gathered_.size() >= kGathered) flush();
  }
  void overwrite(std::uint64_t offset, std::string_view bytes) {
    flush();
    file_.go_to(static_cast<off_t>(offset), SEEK_SET, target_);
    file_.write(bytes, target_);
    file_.go_to(0, SEEK_END, target_);
  }
  void finish() {
    flush();
    file_.move_to(target_);
  }

 private:
  void flush() {
    file_.write(gathered_, target_);
    gathered_.clear();
  }

  fs::path target_;
  TemporaryFile file_;
  std::string gathered_;
};

AtomicFileWriter::AtomicFileWriter(const fs::path& path) {
  std::error_code ignored;
  if (fs::exists(path, ignored) && !fs::is_regular_file(path, ignored))
    throw OutputError(path.string() + ": cannot be written: it is not a regular file");
  impl_ = std::make_unique<Impl>(followed(path));
}
AtomicFileWriter::~AtomicFileWriter() = default;

void AtomicFileWriter::append(std::string_view bytes) {
  impl_->append(bytes);
}
void AtomicFileWriter::overwrite(std::uint64_t offset, std::string_view bytes) {
  impl_->overwrite(offset, bytes);
}
void AtomicFileWriter::finish() {
  impl_->finish();
}

void make_output_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) {
    const std::string why = error ? error.message() : "a file with this name already exists";
    throw OutputError(fmt::format("{}: the output folder cannot be created: {}", folder.string(), why));
  }
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    throw OutputError(fmt::format("{}: the output folder cannot be written to: {}", folder.string(), reason(errno)));
}

void require_short_text(std::string_view text, const std::string& name, std::size_t max_bytes) {
  if (text.size() > max_bytes) refuse_long(name, max_bytes);
}

void require_short_file(const fs::path& path, std::size_t max_bytes) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return;
  if (!fs::is_regular_file(path, ignored)) refuse_unreadable(path, "it is not a regular file");
  if (fs::file_size(path, ignored) > max_bytes) refuse_long(path.string(), max_bytes);
}

std::string read_file(const fs::path& path, std::size_t max_bytes) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) refuse_unreadable(path, "it is a folder");
  require_short_file(path, max_bytes);
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) refuse_unreadable(path, reason(errno != 0 ? errno : ENOENT));
  return read_all(stream, path.string(), max_bytes);
}

std::string read_standard_input(std::size_t max_bytes) {
  return read_all(std::cin, "standard input", max_bytes);
}

}  // namespace retrace
