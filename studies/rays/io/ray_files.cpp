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

RayFormat format_of(const std::filesystem::path& file, Field field) {
  const std::string ending = ending_of(file);
  if (ending == ".tm25ray") return RayFormat::tm25;
  if (ending == ".csv") return RayFormat::csv;
  throw InputError(field, fmt::format("must end in .tm25ray or .csv, got {}", in_quotes(file.string())));
}

}  // namespace

std::unique_ptr<RaySource> open_ray_file(const std::filesystem::path& file, Field field) {
  if (format_of(file, field) == RayFormat::tm25) return std::make_unique<Tm25Source>(file);
  return std::make_unique<RayCsvSource>(file);
}

std::unique_ptr<RaySink> make_ray_file(const std::filesystem::path& file, Field field) {
  if (format_of(file, field) == RayFormat::tm25) return std::make_unique<Tm25Sink>(file);
  return std::make_unique<RayCsvSink>(file);
}

void check_ray_file(const std::filesystem::path& file, Field field) {
  format_of(file, field);
}

}  // namespace retrace::studies
