#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "core/error.h"
#include "core/number_format.h"
#include "studies/rays/io/ray_input.h"
#include "studies/rays/io/tm25.h"
#include "studies/rays/io/tm25_layout.h"
#include "studies/rays/ray_limits.h"

namespace retrace::studies {
namespace {

using namespace tm25;

// Maximum numbers of tables and items. Larger numbers in a file indicate damage.
constexpr std::int32_t kMaxTables = 100'000;
constexpr std::int32_t kMaxItems = 1000;
// Relative tolerance between the sum of the rays' fluxes and the flux in the header.
constexpr double kFluxTolerance = 0.01;
// Tolerance of the squared length of a direction.
constexpr double kUnitTolerance = 1e-4;

static_assert(std::endian::native == std::endian::little, "TM-25 is little-endian, and read as it is");

template <class Value>
Value value_at(const char* bytes) {
  Value value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

/// Returns the UTF-32 characters before the first zero.
std::u32string characters(std::string_view bytes) {
  std::u32string text;
  for (std::size_t k = 0; k + 4 <= bytes.size(); k += 4) {
    const auto character = value_at<char32_t>(bytes.data() + k);
    if (character == 0) break;
    text.push_back(character);
  }
  return text;
}

/// Returns a text for messages and keys, in which question marks replace characters that are not ASCII.
std::string plain(const std::u32string& text) {
  std::string result;
  for (const char32_t c : text) result.push_back(c >= 0x20 && c < 0x7f ? static_cast<char>(c) : '?');
  return result;
}

/// Returns the characters before the first one that is not printable.
std::string ascii_of(std::string_view text) {
  std::string result;
  for (const char c : text.substr(0, text.find('\0'))) {
    if (c < 0x20 || c > 0x7e) break;
    result.push_back(c);
  }
  return result;
}

}  // namespace

Tm25Source::Tm25Source(const std::filesystem::path& file) : Tm25Source(opened_ray_file(file), file.string()) {}

Tm25Source::Tm25Source(RayInput input, std::string file)
    : stream_(std::move(input.stream)), file_(std::move(file)), bytes_(input.bytes) {
  read_header();
}

void Tm25Source::fail(std::uint64_t byte, std::string_view text) const {
  throw InputError({file_, 0, fmt::format("byte {}", byte)}, text);
}

/// Returns the next bytes of the file.
/// \param what name of these bytes, for messages
std::string_view Tm25Source::take(std::uint64_t bytes, std::string_view what) {
  if (bytes > bytes_ - at_)
    fail(at_, fmt::format("the file is too short: {} requires {} bytes, but only {} bytes remain", what, bytes,
                          bytes_ - at_));
  buffer_.resize(bytes);
  stream_->read(buffer_.data(), static_cast<std::streamsize>(bytes));
  if (static_cast<std::uint64_t>(stream_->gcount()) != bytes) fail(at_, "cannot be read");
  at_ += bytes;
  return buffer_;
}

std::int32_t Tm25Source::integer() {
  return value_at<std::int32_t>(take(4, "a number").data());
}

float Tm25Source::number() {
  return value_at<float>(take(4, "a number").data());
}

std::int32_t Tm25Source::integer_within(std::string_view what, std::int32_t min, std::int32_t max) {
  const std::int32_t value = integer();
  if (value >= min && value <= max) return value;
  const std::string allowed = min == max ? fmt::format("{}", min) : fmt::format("{} to {}", min, max);
  fail(at_ - 4, fmt::format("{} must be {}, got {}", what, allowed, value));
}

bool Tm25Source::flag(std::string_view what) {
  return integer_within(what, 0, 1) == 1;
}

/// Reads a flux. NaN means that the file does not give the flux.
std::optional<double> Tm25Source::flux(std::string_view what) {
  const float value = number();
  if (std::isnan(value)) return std::nullopt;
  if (!std::isfinite(value) || value < 0.0F) fail(at_ - 4, fmt::format("{} must be >= 0, got {}", what, value));
  return value;
}

void Tm25Source::read_header() {
  if (take(std::min<std::uint64_t>(4, bytes_), "a ray file") != "TM25")
    fail(0, "the first four bytes must be \"TM25\", as in every ray file of IES TM-25");
  integer_within("the version of the format", kFormatVersion, kFormatVersion);
  integer();  // skips the method by which the rays were made
  info_.luminous_lm = flux("the luminous flux");
  info_.radiant_w = flux("the radiant flux");
  info_.rays = value_at<std::uint64_t>(take(8, "the number of rays").data());
  if (*info_.rays == 0) fail(at_ - 8, "the number of rays must be at least 1, got 0");
  info_.date = ascii_of(take(kDateBytes, "the date"));
  integer();  // skips the surface on which the rays begin
  info_.spectrum = static_cast<RaySpectrum>(integer_within("the spectral data identifier", 0, 4));
  const float wavelength_nm = number();
  if (info_.spectrum == RaySpectrum::one_wavelength) {
    if (!is_wavelength(wavelength_nm)) fail(at_ - 4, wavelength_text(wavelength_nm));
    info_.wavelength_nm = wavelength_nm;
  }
  take(8, "the range of wavelengths");
  const bool has_tables = info_.spectrum == RaySpectrum::one_table || info_.spectrum == RaySpectrum::table_of_each;
  const std::int32_t tables = integer_within("the number of spectral tables", has_tables ? 1 : 0, kMaxTables);
  const std::int32_t items = integer_within("the number of additional items", 0, kMaxItems);
  const std::int32_t text_bytes = integer_within("the size of the additional text", 0, INT32_MAX);
  take(kReservedBytes, "the header");
  read_flags();
  read_texts();
  read_tables(tables);
  find_rays(items, text_bytes);
}

void Tm25Source::read_flags() {
  const std::uint64_t begin = at_;
  for (const std::string_view what : {"the flag of positions", "the flag of directions"}) integer_within(what, 1, 1);
  info_.has_radiant = flag("the flag of radiant flux");
  has_wavelengths_ = flag("the flag of wavelengths");
  info_.has_luminous = flag("the flag of luminous flux");
  info_.has_stokes = flag("the flag of Stokes parameters");
  info_.has_tristimulus = flag("the flag of tristimulus values");
  has_tables_ = flag("the flag of spectrum indices");
  if (!info_.has_radiant && !info_.has_luminous)
    fail(begin + 8, "rays must have radiant or luminous flux, got neither");
  if (info_.has_stokes && !info_.has_radiant)
    fail(begin + 8, "Stokes parameters require the radiant flux of each ray, got none");
  if (info_.has_tristimulus && !info_.has_luminous)
    fail(begin + 16, "tristimulus values require the luminous flux of each ray, got none");
  if (info_.spectrum == RaySpectrum::wavelength_of_each && !has_wavelengths_)
    fail(begin + 12, "the spectral data identifier is 2, but rays have no wavelengths");
  if (has_tables_ != (info_.spectrum == RaySpectrum::table_of_each))
    fail(begin + 28,
         "rays must have a spectrum index if the spectral data identifier is 4, and must not have one otherwise");
  if (has_wavelengths_) info_.spectrum = RaySpectrum::wavelength_of_each;
}

void Tm25Source::read_texts() {
  for (std::u32string& text : info_.texts) text = characters(take(kTextBytes, "a description"));
}

materials::SpectralCurve Tm25Source::read_table(std::int32_t number) {
  const std::uint64_t begin = at_;
  const std::int32_t pairs = integer_within(fmt::format("the length of spectral table {}", number), 1, INT32_MAX);
  const std::string_view data = take(8 * static_cast<std::uint64_t>(pairs), "a spectral table");
  materials::SpectralCurve table;
  double sum = 0.0;
  for (std::size_t k = 0; k < data.size(); k += 8) {
    const double wavelength_nm = value_at<float>(data.data() + k);
    const double weight = value_at<float>(data.data() + k + 4);
    if (!is_wavelength(wavelength_nm)) fail(begin + 4 + k, wavelength_text(wavelength_nm));
    if (!table.wavelengths_nm.empty() && wavelength_nm <= table.wavelengths_nm.back())
      fail(begin + 4 + k, fmt::format("the wavelengths of spectral table {} must be in ascending order", number));
    if (!(weight >= 0.0) || !std::isfinite(weight))
      fail(begin + 8 + k, fmt::format("a value of spectral table {} must be >= 0, got {}", number, weight));
    table.wavelengths_nm.push_back(wavelength_nm);
    table.values.push_back(weight);
    sum += weight;
  }
  if (!(sum > 0.0)) fail(begin, fmt::format("spectral table {} is 0 everywhere", number));
  return table;
}

void Tm25Source::read_tables(std::int32_t count) {
  const std::uint64_t begin = at_;
  for (std::int32_t k = 1; k <= count; ++k) {
    materials::SpectralCurve table = read_table(k);
    const bool matters =
        info_.spectrum == RaySpectrum::table_of_each || (info_.spectrum == RaySpectrum::one_table && k == 1);
    if (matters) info_.tables.push_back(std::move(table));
  }
  if (const std::uint64_t over = (at_ - begin) % kBlockBytes; over > 0) take(kBlockBytes - over, "spectral tables");
}

/// Reads the data between the tables and the rays, and checks that the file contains all rays.
void Tm25Source::find_rays(std::int32_t items, std::int32_t text_bytes) {
  for (std::int32_t k = 0; k < items; ++k)
    info_.more_items.push_back(plain(characters(take(kLabelBytes, "the name of an additional item"))));
  take(static_cast<std::uint64_t>(text_bytes), "the additional text");
  const int columns = 6 + (info_.has_radiant ? 1 : 0) + (has_wavelengths_ ? 1 : 0) + (info_.has_luminous ? 1 : 0) +
                      (info_.has_stokes ? 6 : 0) + (info_.has_tristimulus ? 2 : 0) + (has_tables_ ? 1 : 0) + items;
  record_bytes_ = 4 * static_cast<std::size_t>(columns);
  const std::uint64_t left = bytes_ - at_;
  if (left / record_bytes_ == *info_.rays && left % record_bytes_ == 0) return;
  fail(at_,
       fmt::format("the rest of the file must contain {} bytes for each ray (number of rays: {}), but has {} bytes",
                   record_bytes_, *info_.rays, left));
}

double Tm25Source::fraction_read() const {
  return static_cast<double>(rays_read_) / static_cast<double>(*info_.rays);
}

bool Tm25Source::read(std::size_t max_rays, std::vector<SetRay>& rays) {
  rays.clear();
  const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(max_rays, *info_.rays - rays_read_));
  if (count == 0) return false;
  const std::uint64_t begin = at_;
  const std::string_view records = take(count * record_bytes_, "rays");
  rays.reserve(count);
  for (std::size_t k = 0; k < count; ++k)
    rays.push_back(ray_at(records.data() + k * record_bytes_, begin + k * record_bytes_));
  rays_read_ += count;
  return true;
}

SetRay Tm25Source::ray_at(const char* record, std::uint64_t byte) {
  const char* at = record;
  const auto place = [&] { return byte + static_cast<std::uint64_t>(at - record); };
  const auto next = [&](std::string_view what) {
    const double value = value_at<float>(at);
    if (!std::isfinite(value)) fail(place(), fmt::format("{} must be a number, got {}", what, value));
    at += 4;
    return value;
  };
  const auto flux_of = [&](std::string_view what) {
    const double value = next(what);
    if (value < 0.0) fail(place() - 4, fmt::format("{} must be >= 0, got {}", what, shortest(value)));
    return value;
  };
  SetRay ray;
  for (double& coordinate : ray.position_mm) coordinate = next("a coordinate");
  for (double& cosine : ray.direction) cosine = next("a direction cosine");
  const double length2 = ray.direction.squaredNorm();
  if (!(length2 > 0.0)) fail(byte + 12, "a direction must not be the zero vector");
  if (std::abs(length2 - 1.0) > kUnitTolerance) ++not_unit_;
  ray.direction /= std::sqrt(length2);
  if (info_.has_radiant) radiant_w_ += ray.radiant_w = flux_of("the radiant flux of a ray");
  if (has_wavelengths_) {
    ray.wavelength_nm = next("a wavelength");
    if (!is_wavelength(ray.wavelength_nm)) fail(place() - 4, wavelength_text(ray.wavelength_nm));
  }
  if (info_.has_luminous) luminous_lm_ += ray.luminous_lm = flux_of("the luminous flux of a ray");
  if (info_.has_stokes) {
    for (double& s : ray.stokes) s = next("a Stokes parameter");
    for (double& a : ray.axis) a = next("an axis of polarisation");
    if (const char* const wrong = orthogonalize_stokes_axis(ray)) fail(place() - 24, wrong);
  }
  if (info_.has_tristimulus) {
    ray.tristimulus_x = flux_of("a tristimulus value");
    ray.tristimulus_z = flux_of("a tristimulus value");
  }
  // The index of a spectral table is read only if the rays have no wavelengths of their own. Such wavelengths are more
  // precise than spectral tables.
  if (info_.spectrum == RaySpectrum::table_of_each) {
    const double table = next("a spectrum index");
    if (!(table >= 1.0 && table <= static_cast<double>(info_.tables.size())) || table != std::floor(table))
      fail(place() - 4, fmt::format("a spectrum index must be 1 to {}, got {}", info_.tables.size(), shortest(table)));
    ray.table = static_cast<std::uint32_t>(table);
  }
  return ray;
}

Warnings Tm25Source::warnings() const {
  Warnings told;
  const auto compare = [&](std::string_view what, const std::optional<double>& said, bool is_there, double found) {
    if (!is_there || !said || *said == 0.0 || std::abs(found - *said) <= kFluxTolerance * *said) return;
    told.push_back(
        {"flux_disagrees",
         fmt::format("{}: the header gives {:.6g} {}, but the rays add up to {:.6g}; the sum of the rays is used",
                     file_, *said, what, found)});
  };
  if (rays_read_ == *info_.rays) {
    compare("W", info_.radiant_w, info_.has_radiant, radiant_w_);
    compare("lm", info_.luminous_lm, info_.has_luminous, luminous_lm_);
  }
  if (not_unit_ > 0)
    told.push_back(
        {"directions_normalised",
         fmt::format("{}: the directions of {} rays are not unit vectors; they were normalized", file_, not_unit_)});
  std::string names;
  for (const std::string& name : info_.more_items)
    if (name != "account") names += (names.empty() ? "" : ", ") + name;
  if (!names.empty())
    told.push_back({"items_omitted", fmt::format("{}: additional items are ignored: {}", file_, names)});
  return told;
}

}  // namespace retrace::studies
