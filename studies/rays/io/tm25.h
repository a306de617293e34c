#pragma once

// Ray files of IES TM-25-13: source and sink that read and write the binary format. Layout and interpretation:
// docs/theory/rays.md.

#include <cstdint>
#include <filesystem>
#include <istream>
#include <memory>
#include <string>

#include "core/atomic_file.h"
#include "core/warning.h"
#include "studies/rays/io/ray_input.h"
#include "studies/rays/ray_source.h"

namespace retrace::studies {

/// Reads a file of rays.
/// \throw InputError with the file and the position of the error in bytes
class Tm25Source : public RaySource {
 public:
  /// Opens a regular file (not a pipe or a device).
  explicit Tm25Source(const std::filesystem::path& file);
  /// \param file name of the input, for messages
  Tm25Source(RayInput input, std::string file);

  const RaySetInfo& info() const override { return info_; }
  bool read(std::size_t max_rays, std::vector<SetRay>& rays) override;
  double fraction_read() const override;
  Warnings warnings() const override;

 private:
  [[noreturn]] void fail(std::uint64_t byte, std::string_view text) const;
  std::string_view take(std::uint64_t bytes, std::string_view what);
  std::int32_t integer();
  float number();
  std::int32_t integer_within(std::string_view what, std::int32_t min, std::int32_t max);
  std::optional<double> flux(std::string_view what);
  bool flag(std::string_view what);
  void read_header();
  void read_flags();
  void read_texts();
  void read_tables(std::int32_t count);
  materials::SpectralCurve read_table(std::int32_t number);
  void find_rays(std::int32_t items, std::int32_t text_bytes);
  SetRay ray_at(const char* record, std::uint64_t byte);

  std::unique_ptr<std::istream> stream_;
  std::string file_;
  std::uint64_t bytes_ = 0;
  std::uint64_t at_ = 0;  ///< number of bytes that have been read
  std::string buffer_;
  RaySetInfo info_;
  std::size_t record_bytes_ = 0;
  std::uint64_t rays_read_ = 0;
  bool has_wavelengths_ = false;
  bool has_tables_ = false;
  std::uint64_t not_unit_ = 0;  ///< number of directions that are not unit vectors
  double radiant_w_ = 0.0;
  double luminous_lm_ = 0.0;
};

/// Writes a file of rays. Each ray has its account (category of power in the ledger) as an additional item.
class Tm25Sink : public RaySink {
 public:
  /// \throw OutputError if the file cannot be written
  explicit Tm25Sink(const std::filesystem::path& file) : file_(file) {}

  void begin(const RaySinkLayout& layout) override;
  void write(std::span<const AccountedRay> rays) override;
  void finish() override;

 private:
  void write_header();
  void write_totals();

  AtomicFileWriter file_;
  RaySinkLayout layout_;
  bool has_wavelength_column_ = false;
  std::uint64_t rays_ = 0;
  double radiant_w_ = 0.0;
  double luminous_lm_ = 0.0;
  double shortest_nm_ = 0.0;  ///< shortest wavelength of the rays; 0: no rays yet
  double longest_nm_ = 0.0;
};

}  // namespace retrace::studies
