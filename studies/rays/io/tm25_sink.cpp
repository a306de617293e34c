#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "core/version.h"
#include "studies/rays/io/tm25.h"
#include "studies/rays/io/tm25_layout.h"
#include "studies/rays/ray_accounts.h"

namespace retrace::studies {
namespace {

using namespace tm25;

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

/// Buffer that collects values in their binary representation.
class Bytes {
 public:
  template <class Value>
  void add(Value value) {
    const std::size_t at = bytes_.size();
    bytes_.resize(at + sizeof value);
    std::memcpy(bytes_.data() + at, &value, sizeof value);
  }
  void add_real(double value) { add(static_cast<float>(value)); }
  void add_flag(bool value) { add(static_cast<std::int32_t>(value)); }
  /// \param bytes size that the text is padded to with zeros; at least one character is zero
  void add_text(std::u32string_view text, std::size_t bytes) {
    const std::size_t at = bytes_.size();
    bytes_.resize(at + bytes, '\0');
    std::memcpy(bytes_.data() + at, text.data(), std::min(bytes - 4, 4 * text.size()));
  }
  void fill(std::size_t bytes) { bytes_.resize(bytes_.size() + bytes, '\0'); }
  void add_date(std::string_view date) {
    const std::size_t at = bytes_.size();
    fill(kDateBytes);
    std::copy_n(date.data(), std::min(date.size(), kDateBytes), bytes_.begin() + static_cast<std::ptrdiff_t>(at));
  }
  const std::string& text() const { return bytes_; }
  void clear() { bytes_.clear(); }

 private:
  std::string bytes_;
};

std::u32string wide(std::string_view ascii) {
  return {ascii.begin(), ascii.end()};
}

/// Returns an explanation of the numbers in the additional item `account`.
std::u32string legend() {
  std::string text = "account:";
  for (std::size_t k = 0; k < kRayAccounts.size(); ++k)
    text += fmt::format("{} {} = {}", k == 0 ? "" : ",", k, kRayAccounts[k]);
  return wide(text);
}

}  // namespace

void Tm25Sink::begin(const RaySinkLayout& layout) {
  layout_ = layout;
  // The format allows no wavelengths together with luminous flux.
  has_wavelength_column_ = layout.has_wavelengths && !layout.info.has_luminous;
  write_header();
}

void Tm25Sink::write_header() {
  const RaySetInfo& info = layout_.info;
  const bool has_wavelength_item = layout_.has_wavelengths && !has_wavelength_column_;
  RaySpectrum spectrum = info.spectrum;
  if (layout_.has_wavelengths)
    spectrum = has_wavelength_column_ ? RaySpectrum::wavelength_of_each : RaySpectrum::unknown;
  const std::u32string more = legend();
  const std::size_t more_bytes = (4 * (more.size() + 1) + kBlockBytes - 1) / kBlockBytes * kBlockBytes;
  Bytes head;
  for (const char c : {'T', 'M', '2', '5'}) head.add(c);
  head.add(kFormatVersion);
  head.add(std::int32_t{0});  // rays are from a simulation
  head.add_real(kUnknown);    // the flux is unknown here; write_totals() sets it and the number of rays
  head.add_real(kUnknown);
  head.add(std::uint64_t{0});
  head.add_date(info.date);
  head.add(std::int32_t{0});  // the surface on which rays begin is unknown
  head.add(static_cast<std::int32_t>(spectrum));
  head.add_real(spectrum == RaySpectrum::one_wavelength ? info.wavelength_nm : kUnknown);
  head.add_real(kUnknown);
  head.add_real(kUnknown);
  head.add(std::int32_t{0});  // number of spectral tables
  head.add(static_cast<std::int32_t>(has_wavelength_item ? 2 : 1));
  head.add(static_cast<std::int32_t>(more_bytes));
  head.fill(kReservedBytes);
  for (const bool is_there : {true, true, info.has_radiant, has_wavelength_column_, info.has_luminous, info.has_stokes,
                              info.has_tristimulus, false})
    head.add_flag(is_there);
  for (const std::u32string& text : info.texts) head.add_text(text, kTextBytes);
  head.add_text(U"account", kLabelBytes);
  if (has_wavelength_item) head.add_text(U"wavelength_nm", kLabelBytes);
  head.add_text(more, more_bytes);
  file_.append(head.text());
}

void Tm25Sink::write(std::span<const AccountedRay> rays) {
  const RaySetInfo& info = layout_.info;
  Bytes records;
  for (const AccountedRay& ray : rays) {
    for (const double coordinate : ray.position_mm) records.add_real(coordinate);
    for (const double cosine : ray.direction) records.add_real(cosine);
    if (info.has_radiant) records.add_real(ray.radiant_w);
    if (has_wavelength_column_) records.add_real(ray.wavelength_nm);
    if (info.has_luminous) records.add_real(ray.luminous_lm);
    if (info.has_stokes) {
      for (const double s : ray.stokes) records.add_real(s);
      for (const double a : ray.axis) records.add_real(a);
    }
    if (info.has_tristimulus) {
      records.add_real(ray.tristimulus_x);
      records.add_real(ray.tristimulus_z);
    }
    records.add_real(static_cast<double>(ray.account));
    if (layout_.has_wavelengths && !has_wavelength_column_) records.add_real(ray.wavelength_nm);
    radiant_w_ += ray.radiant_w;
    luminous_lm_ += ray.luminous_lm;
    shortest_nm_ = shortest_nm_ > 0.0 ? std::min(shortest_nm_, ray.wavelength_nm) : ray.wavelength_nm;
    longest_nm_ = std::max(longest_nm_, ray.wavelength_nm);
  }
  file_.append(records.text());
  rays_ += rays.size();
}

void Tm25Sink::write_totals() {
  Bytes totals;
  totals.add_real(layout_.info.has_luminous ? luminous_lm_ : kUnknown);
  totals.add_real(layout_.info.has_radiant ? radiant_w_ : kUnknown);
  totals.add(rays_);
  file_.overwrite(kTotalsAt, totals.text());
  if (!has_wavelength_column_) return;
  Bytes range;
  range.add_real(shortest_nm_);
  range.add_real(longest_nm_);
  file_.overwrite(kRangeAt, range.text());
}

void Tm25Sink::finish() {
  write_totals();
  file_.finish();
}

}  // namespace retrace::studies
