#include "studies/rays/io/ray_csv.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/csv.h"
#include "core/error.h"
#include "core/message_text.h"
#include "core/text.h"
#include "studies/rays/io/ray_input.h"
#include "studies/rays/ray_accounts.h"
#include "studies/rays/ray_limits.h"

namespace retrace::studies {
namespace {

/// Indices of the columns in kNames. Position, direction, Stokes parameters and their axis occupy three columns each,
/// from the given index.
enum Quantity : std::size_t {
  kPosition = 0,
  kDirection = 3,
  kPower = 6,
  kLuminous,
  kWavelength,
  kStokes,
  kAxis = 12,
  kNumber = 15,
  kAccount
};
constexpr std::array<std::string_view, 17> kNames = {"x_mm",    "y_mm",        "z_mm",          "dx",  "dy",     "dz",
                                                     "power_w", "luminous_lm", "wavelength_nm", "s1",  "s2",     "s3",
                                                     "axis_x",  "axis_y",      "axis_z",        "ray", "account"};
constexpr std::size_t kMaxLineBytes = 64 * 1024;
constexpr int kMaxLines = 2'000'000'000;

std::string all_names() {
  std::string text;
  for (const std::string_view name : kNames) text += (text.empty() ? "" : ", ") + std::string(name);
  return text;
}

}  // namespace

RayCsvSource::RayCsvSource(const std::filesystem::path& file) : RayCsvSource(opened_ray_file(file), file.string()) {}

RayCsvSource::RayCsvSource(RayInput input, std::string file)
    : stream_(std::move(input.stream)), file_(std::move(file)), bytes_(input.bytes) {
  read_names();
}

void RayCsvSource::fail(std::string_view column, std::string_view text) const {
  throw InputError({file_, line_, std::string(column)}, text);
}

/// Reads the next line that is not empty and splits it into values. Returns false if there is none.
bool RayCsvSource::next_line() {
  text_.resize(kMaxLineBytes);
  while (stream_->getline(text_.data(), static_cast<std::streamsize>(text_.size())) || stream_->gcount() > 0) {
    const auto read = static_cast<std::size_t>(stream_->gcount());
    at_ += read;
    line_ = std::min(line_ + 1, kMaxLines);
    if (read + 1 >= text_.size()) fail("", fmt::format("must have at most {} characters", kMaxLineBytes - 2));
    std::string_view line(text_.data(), read - (stream_->eof() ? 0 : 1));
    if (line_ == 1 && line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
    line = trimmed(line);
    if (line.empty() || line.front() == '#') continue;
    values_ = split(line, ',');
    return true;
  }
  values_.clear();
  return false;
}

void RayCsvSource::read_names() {
  columns_.fill(-1);
  if (!next_line()) fail("", "the file has no line of column names");
  column_count_ = values_.size();
  for (std::size_t k = 0; k < values_.size(); ++k) {
    const auto found = std::find(kNames.begin(), kNames.end(), values_[k]);
    if (found == kNames.end())
      fail("", fmt::format("a column must be one of {}, got {}", all_names(), in_quotes(values_[k])));
    int& column = columns_[static_cast<std::size_t>(found - kNames.begin())];
    if (column >= 0) fail("", fmt::format("the column {} occurs twice", *found));
    column = static_cast<int>(k);
  }
  for (std::size_t k = kPosition; k < kPower; ++k)
    if (!has(k)) fail("", fmt::format("the column {} is missing in the header", kNames[k]));
  const auto all_or_none = [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k <= last; ++k)
      if (has(k) != has(first))
        fail("", fmt::format("the header must contain all columns from {} to {}, or none of them", kNames[first],
                             kNames[last]));
  };
  all_or_none(kStokes, kNumber - 1);
  info_.has_radiant = has(kPower);
  info_.has_luminous = has(kLuminous);
  info_.has_stokes = has(kStokes);
  if (has(kWavelength)) info_.spectrum = RaySpectrum::wavelength_of_each;
  if (!info_.has_radiant && !info_.has_luminous) fail("", "the column power_w or luminous_lm is missing in the header");
}

double RayCsvSource::value(std::size_t quantity, bool not_negative) const {
  const std::string_view text = values_[static_cast<std::size_t>(columns_[quantity])];
  const std::optional<double> number = number_in(text);
  if (!number || (not_negative && *number < 0.0))
    fail(kNames[quantity], fmt::format("must be a number{}, got {}", not_negative ? " >= 0" : "", in_quotes(text)));
  return *number;
}

SetRay RayCsvSource::ray() const {
  SetRay ray;
  const auto vector = [&](std::size_t first) -> std::array<double, 3> {
    return {value(first), value(first + 1), value(first + 2)};
  };
  ray.position_mm = Vec3(vector(kPosition).data());
  const std::optional<Vec3> direction = unit_along(Vec3(vector(kDirection).data()));
  if (!direction) fail("dx", "a direction must have a length above 0");
  ray.direction = *direction;
  if (has(kPower)) ray.radiant_w = value(kPower, true);
  if (has(kLuminous)) ray.luminous_lm = value(kLuminous, true);
  if (has(kWavelength)) {
    ray.wavelength_nm = value(kWavelength);
    if (!is_wavelength(ray.wavelength_nm)) fail("wavelength_nm", wavelength_text(ray.wavelength_nm));
  }
  if (!has(kStokes)) return ray;
  ray.stokes = vector(kStokes);
  ray.axis = Vec3(vector(kAxis).data());
  if (const char* const wrong = orthogonalize_stokes_axis(ray)) fail("s1", wrong);
  return ray;
}

bool RayCsvSource::read(std::size_t max_rays, std::vector<SetRay>& rays) {
  rays.clear();
  while (rays.size() < max_rays && next_line()) {
    if (values_.size() != column_count_)
      fail("", fmt::format("a line must have {} values, one for each column, got {}", column_count_, values_.size()));
    rays.push_back(ray());
    const std::size_t larger = rays.back().radiant_w >= rays.back().luminous_lm ? kPower : kLuminous;
    if (!total_.add(rays.back())) fail(kNames[larger], total_power_text(value(larger)));
  }
  return !rays.empty();
}

double RayCsvSource::fraction_read() const {
  return bytes_ > 0 ? std::min(1.0, static_cast<double>(at_) / static_cast<double>(bytes_)) : 1.0;
}

void RayCsvSink::begin(const RaySinkLayout& layout) {
  layout_ = layout;
  std::string names;
  const auto add = [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k <= last; ++k) names += (names.empty() ? "" : ",") + std::string(kNames[k]);
  };
  add(kNumber, kAccount);
  add(kPosition, kPower - 1);
  if (layout.info.has_radiant) add(kPower, kPower);
  if (layout.info.has_luminous) add(kLuminous, kLuminous);
  if (layout.has_wavelengths) add(kWavelength, kWavelength);
  if (layout.info.has_stokes) add(kStokes, kNumber - 1);
  file_.append(names + '\n');
}

void RayCsvSink::write(std::span<const AccountedRay> rays) {
  CsvWriter table;
  for (const AccountedRay& ray : rays) {
    table.add(ray.number);
    table.add(kRayAccounts[ray.account]);
    table.add(ray.position_mm);
    table.add(ray.direction);
    if (layout_.info.has_radiant) table.add(ray.radiant_w);
    if (layout_.info.has_luminous) table.add(ray.luminous_lm);
    if (layout_.has_wavelengths) table.add(ray.wavelength_nm);
    if (layout_.info.has_stokes) {
      table.add(ray.stokes);
      table.add(ray.axis);
    }
    table.end_row();
  }
  file_.append(table.text());
}

}  // namespace retrace::studies
