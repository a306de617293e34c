#pragma once

// Files as a whole: outputs that appear completely or not at all, and inputs that are read up to a limit on their size.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace retrace {

/// Replaces `path` by a file that holds `content`, as a whole or not at all: it is written beside it under another name
/// and moved into place. \throw OutputError naming the path and the reason; `path` is then as it was.
void write_file_atomically(const std::filesystem::path& path, std::string_view content);

/// A file of any length that is written piece by piece, and appears under its name when it is finished.
class GrowingFile {
 public:
  /// \throw OutputError if it cannot be written; what has the name already must be a regular file
  explicit GrowingFile(const std::filesystem::path& path);
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;
  /// Nothing is left of a file that is not finished.
  ~GrowingFile();

  /// \throw OutputError
  void append(std::string_view bytes);
  /// Writes again what stands from `offset` on. \pre it has been written \throw OutputError
  void overwrite(std::uint64_t offset, std::string_view bytes);
  /// Replaces what was there under its name. \throw OutputError
  void finish();

 private:
  class Hidden;
  std::unique_ptr<Hidden> hidden_;
};

/// Makes `folder` and its parents where they are missing. \throw OutputError if that cannot be done or if it is no
/// folder that can be written to.
void make_output_folder(const std::filesystem::path& folder);

/// Most bytes that files of a kind may have, so that one without end, such as /dev/zero, is refused.
inline constexpr std::size_t kMostTextBytes = std::size_t{64} << 20;  ///< jobs, machines, parts, tables
inline constexpr std::size_t kMostDataBytes = std::size_t{1} << 30;   ///< meshes, height maps, NC programs, pictures

/// The whole content of a file. \throw InputError if it cannot be opened or read or is longer; folders are refused.
std::string read_file(const std::filesystem::path& path, std::size_t most_bytes = kMostTextBytes);

/// What is left of standard input. \throw InputError as read_file()
std::string read_standard_input(std::size_t most_bytes);

/// Before a library reads a file by itself. What is not there is left to the library. \throw InputError if it is no
/// regular file or is longer
void require_short_file(const std::filesystem::path& path, std::size_t most_bytes);

/// \throw InputError if the text of a file is longer
void require_short_text(std::string_view text, const std::string& name, std::size_t most_bytes);

}  // namespace retrace
