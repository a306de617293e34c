#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace retrace {

/// Replaces `path` by a file that holds `content`, as a whole or not at all: it is written beside it under another name
/// and moved into place. \throw OutputError naming the path and the reason; `path` is then as it was.
void write_file_atomically(const std::filesystem::path& path, std::string_view content);

/// Makes `folder` and its parents where they are missing. \throw OutputError if that cannot be done or if it is no
/// folder that can be written to.
void make_output_folder(const std::filesystem::path& folder);

/// The whole content of a file. \throw InputError if it cannot be opened or read; folders are refused.
std::string read_file(const std::filesystem::path& path);

}  // namespace retrace
