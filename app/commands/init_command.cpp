#include <fmt/format.h>

#include <filesystem>

#include "app/commands.h"
#include "app/output.h"
#include "core/data_directory.h"
#include "design/io/design_format.h"
#include "design/io/init_templates.h"
#include "fabrication/planing/io/part_files.h"

namespace retrace::app {
namespace {

struct InitOptions {
  std::string kind;
  bool editor = false;
};

std::vector<Argument> arguments(InitOptions& options) {
  const auto kinds = [] {
    Words words = words_of(design::design_kinds())();
    words.emplace_back("round_zone_lens");
    return words;
  };
  return {
      {"KIND", "rtp, hexagonal_icc, triangular_icc, round_icc or round_zone_lens", &options.kind, one_of(kinds)},
      {"--editor", "add a first line that names the JSON Schema of the file for editors, by its path on this machine",
       &options.editor}};
}

/// Returns the URL of a file (RFC 3986). Bytes other than letters, digits and "/-._~" are written as %XX.
std::string url_of(const std::filesystem::path& file) {
  std::string url = "file://";
  for (const char c : file.string()) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                          std::string_view("/-._~").find(c) != std::string_view::npos;
    url += is_plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return url;
}

/// Returns the comment line with the JSON Schema of the file. It is read by Taplo and by editors that use it, such as
/// Even Better TOML.
std::string schema_line(const std::string& kind) {
  const schema::Format& format =
      kind == "round_zone_lens" ? fabrication::planed_part_format() : design::design_format();
  return fmt::format("#:schema {}\n", url_of(schema_file(format.name)));
}

ExitCode run(const InitOptions& options, const CommonOptions& common) {
  std::string text = design::design_template(options.kind);
  if (options.editor) text = schema_line(options.kind) + text;
  // An existing file is never overwritten, because it may be a design on which the user has worked.
  if (!common.out.empty() &&
      std::filesystem::symlink_status(common.out).type() != std::filesystem::file_type::not_found)
    throw OutputError(common.out +
                      ": the file exists already and is not overwritten; give another name or remove the file");
  return write_text(common, "retrace.template/1", {{"kind", options.kind}}, text);
}

}  // namespace

Command init_command() {
  return {.name = "init",
          .summary = "a commented design or part file to start from",
          .manual =
              "Prints a commented design that can be computed without changes, or, with the kind `round_zone_lens`, a "
              "part for `plane`. `--out FILE` writes it to a new file. `--editor` adds a first line that names the "
              "JSON Schema of the file, so that editors complete and check its keys. The path in this line is valid "
              "only on this machine.",
          .writes = {"retrace.template/1"},
          .refuses_set = "not allowed with init, which writes its template unchanged; edit the file instead",
          .begin = begins<InitOptions>(arguments, run)};
}

}  // namespace retrace::app
