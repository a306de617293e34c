#pragma once

// Writes output files atomically: a file appears complete or not at all. Reads input files up to a maximum size.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace retrace {

/// Replaces `path` by a file with the given content. The content is written to a temporary file in the same folder,
/// which is then renamed.
/// \throw OutputError with the path and the reason; `path` is then unchanged
void write_file_atomically(const std::filesystem::path& path, std::string_view content);

/// Output file of any length that is written in parts. The bytes go to a temporary file, which gets its final name in
/// finish().
class AtomicFileWriter {
 public:
  /// \throw OutputError if the file cannot be written, or if `path` exists and is not a regular file
  explicit AtomicFileWriter(const std::filesystem::path& path);
  AtomicFileWriter(const AtomicFileWriter&) = delete;
  AtomicFileWriter& operator=(const AtomicFileWriter&) = delete;
  /// Removes the temporary file unless finish() was called.
  ~AtomicFileWriter();

  /// \throw OutputError
  void append(std::string_view bytes);
  /// Overwrites bytes from position `offset` on.
  /// \pre bytes at these positions were already appended
  /// \throw OutputError
  void overwrite(std::uint64_t offset, std::string_view bytes);
  /// Completes the file and moves it to its name, where it replaces an existing file.
  /// \throw OutputError
  void finish();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// Creates `folder` and its parents if they do not exist.
/// \throw OutputError if `folder` cannot be created, is not a folder, or is not writable
void make_output_folder(const std::filesystem::path& folder);

/// Maximum size of input files in bytes. Infinite files, such as /dev/zero, are thus refused.
inline constexpr std::size_t kMaxTextBytes = std::size_t{64} << 20;  ///< for jobs, machines, parts and tables
inline constexpr std::size_t kMaxDataBytes = std::size_t{1} << 30;   ///< for meshes, height maps, NC programs, pictures

/// Returns the content of a file.
/// \throw InputError if the file cannot be read, is a folder, or has more than `max_bytes` bytes
std::string read_file(const std::filesystem::path& path, std::size_t max_bytes = kMaxTextBytes);

/// Returns the content of standard input from the current position on.
/// \throw InputError if standard input cannot be read or has more than `max_bytes` bytes
std::string read_standard_input(std::size_t max_bytes);

/// Checks the size of a file before another library reads the file. Accepts a file that does not exist, because the
/// library that reads the file reports this error.
/// \throw InputError if the file is not a regular file or has more than `max_bytes` bytes
void require_short_file(const std::filesystem::path& path, std::size_t max_bytes);

/// Checks the size of a text that was read from a file.
/// \param name name of the file in messages
/// \throw InputError if the text has more than `max_bytes` bytes
void require_short_text(std::string_view text, const std::string& name, std::size_t max_bytes);

}  // namespace retrace
