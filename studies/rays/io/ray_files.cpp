#include "studies/rays/io/ray_files.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/message_text.h"
#include "core/text.h"
#include "studies/rays/io/ray_csv.h"
#include "studies/rays/io/tm25.h"

namespace retrace::studies {
namespace {

enum class RayFormat { tm25, csv };

RayFormat format_of(const std::filesystem::path& file, const std::string& option) {
  const std::string ending = ending_of(file);
  if (ending == ".tm25ray") return RayFormat::tm25;
  if (ending == ".csv") return RayFormat::csv;
  throw InputError({"", 0, option}, fmt::format("must be a file .tm25ray or .csv, got {}", in_quotes(file.string())));
}

}  // namespace

std::unique_ptr<RaySource> open_ray_file(const std::filesystem::path& file, const std::string& option) {
  if (format_of(file, option) == RayFormat::tm25) return std::make_unique<Tm25Source>(file);
  return std::make_unique<RayCsvSource>(file);
}

std::unique_ptr<RaySink> make_ray_file(const std::filesystem::path& file, const std::string& option) {
  if (format_of(file, option) == RayFormat::tm25) return std::make_unique<Tm25Sink>(file);
  return std::make_unique<RayCsvSink>(file);
}

void check_ray_file(const std::filesystem::path& file, const std::string& option) {
  format_of(file, option);
}

}  // namespace retrace::studies
