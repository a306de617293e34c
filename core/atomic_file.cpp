#include "core/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <iostream>
#include <system_error>

#include "core/error.h"

namespace retrace {
namespace fs = std::filesystem;
namespace {

std::string reason(int error_number) {
  return std::generic_category().message(error_number);
}

/// Owns a file under a temporary name until it is moved into place; otherwise removes it.
class TemporaryFile {
 public:
  explicit TemporaryFile(const fs::path& target)
      : name_(target.parent_path() / fmt::format(".{}.{}.tmp", target.filename().string(), ::getpid())) {
    descriptor_ = ::open(name_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (descriptor_ < 0) throw OutputError(fmt::format("{}: cannot be written: {}", target.string(), reason(errno)));
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!moved_) ::unlink(name_.c_str());
  }

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
    const int descriptor = descriptor_;
    descriptor_ = -1;
    if (::close(descriptor) != 0) fail(target);
    if (::rename(name_.c_str(), target.c_str()) != 0) fail(target);
    moved_ = true;
  }

 private:
  [[noreturn]] static void fail(const fs::path& target) {
    throw OutputError(fmt::format("{}: cannot be written: {}", target.string(), reason(errno)));
  }

  fs::path name_;
  int descriptor_ = -1;
  bool moved_ = false;
};

/// Through a symbolic link the file it points to is replaced or made, not the link.
fs::path followed(const fs::path& path) {
  std::error_code ignored;
  return fs::is_symlink(path, ignored) ? fs::weakly_canonical(path.parent_path() / fs::read_symlink(path)) : path;
}

[[noreturn]] void refuse_unreadable(const fs::path& path, const std::string& why) {
  throw InputError(InputLocation{path.string(), 0, ""}, "cannot be read: " + why);
}

[[noreturn]] void refuse_long(const std::string& name, std::size_t most_bytes) {
  throw InputError(InputLocation{name, 0, ""}, fmt::format("must have at most {} bytes, got more", most_bytes));
}

/// Everything from a stream that may never end; no more is read than shows that it is too long.
std::string read_all(std::istream& stream, const std::string& name, std::size_t most_bytes) {
  constexpr std::size_t kPieceBytes = std::size_t{1} << 20;
  std::string text;
  while (stream && text.size() <= most_bytes) {
    const std::size_t before = text.size();
    text.resize(before + std::min(kPieceBytes, most_bytes + 1 - before));
    stream.read(text.data() + before, static_cast<std::streamsize>(text.size() - before));
    text.resize(before + static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) refuse_unreadable(name, "read error");
  require_short_text(text, name, most_bytes);
  return text;
}

}  // namespace

void write_file_atomically(const fs::path& path, std::string_view content) {
  std::error_code ignored;
  if (fs::exists(path, ignored) && !fs::is_regular_file(path, ignored)) {
    // A device such as /dev/null or a pipe has no "before" to keep: write through it.
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

/// Pieces are gathered, as many are small.
class GrowingFile::Hidden {
 public:
  explicit Hidden(fs::path target) : target_(std::move(target)), file_(target_) {}

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

GrowingFile::GrowingFile(const fs::path& path) {
  std::error_code ignored;
  if (fs::exists(path, ignored) && !fs::is_regular_file(path, ignored))
    throw OutputError(path.string() + ": cannot be written: it is no regular file");
  hidden_ = std::make_unique<Hidden>(followed(path));
}
GrowingFile::~GrowingFile() = default;

void GrowingFile::append(std::string_view bytes) {
  hidden_->append(bytes);
}
void GrowingFile::overwrite(std::uint64_t offset, std::string_view bytes) {
  hidden_->overwrite(offset, bytes);
}
void GrowingFile::finish() {
  hidden_->finish();
}

void make_output_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder)) {
    const std::string why = error ? error.message() : "a file of that name is in the way";
    throw OutputError(fmt::format("{}: the output folder cannot be made: {}", folder.string(), why));
  }
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    throw OutputError(fmt::format("{}: the output folder cannot be written to: {}", folder.string(), reason(errno)));
}

void require_short_text(std::string_view text, const std::string& name, std::size_t most_bytes) {
  if (text.size() > most_bytes) refuse_long(name, most_bytes);
}

void require_short_file(const fs::path& path, std::size_t most_bytes) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return;
  if (!fs::is_regular_file(path, ignored)) refuse_unreadable(path, "it is no regular file");
  if (fs::file_size(path, ignored) > most_bytes) refuse_long(path.string(), most_bytes);
}

std::string read_file(const fs::path& path, std::size_t most_bytes) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) refuse_unreadable(path, "it is a folder");
  if (fs::is_regular_file(path, ignored)) require_short_file(path, most_bytes);
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) refuse_unreadable(path, reason(errno != 0 ? errno : ENOENT));
  return read_all(stream, path.string(), most_bytes);
}

std::string read_standard_input(std::size_t most_bytes) {
  return read_all(std::cin, "standard input", most_bytes);
}

}  // namespace retrace
