#pragma once

// Reads and writes rays as tables of comma-separated values, with one line for each ray.

#include <array>
#include <cstdint>
#include <filesystem>
#include <istream>
#include <memory>
#include <string>
#include <string_view>

#include "core/atomic_file.h"
#include "studies/rays/io/ray_input.h"
#include "studies/rays/ray_limits.h"
#include "studies/rays/ray_source.h"

namespace retrace::studies {

/// Reads a table of rays.
/// \throw InputError with file, line and column
class RayCsvSource : public RaySource {
 public:
  explicit RayCsvSource(const std::filesystem::path& file);
  /// \param file name of the input, for messages
  RayCsvSource(RayInput input, std::string file);

  const RaySetInfo& info() const override { return info_; }
  bool read(std::size_t max_rays, std::vector<SetRay>& rays) override;
  double fraction_read() const override;

 private:
  [[noreturn]] void fail(std::string_view column, std::string_view text) const;
  bool next_line();
  void read_names();
  double value(std::size_t quantity, bool not_negative = false) const;
  bool has(std::size_t quantity) const { return columns_[quantity] >= 0; }
  SetRay ray() const;

  std::unique_ptr<std::istream> stream_;
  std::string file_;
  std::uint64_t bytes_ = 0;
  std::uint64_t at_ = 0;
  std::string text_;
  std::vector<std::string_view> values_;  ///< values in the current line
  std::array<int, 17> columns_ = {};      ///< column of each quantity; -1: the table does not have it
  std::size_t column_count_ = 0;
  int line_ = 0;
  TotalPower total_;
  RaySetInfo info_;
};

/// Writes a table of rays. Each line contains the number of the incident ray and the account of the ledger (category of
/// power) to which the ray's power belongs.
class RayCsvSink : public RaySink {
 public:
  /// \throw OutputError if the file cannot be written
  explicit RayCsvSink(const std::filesystem::path& file) : file_(file) {}

  void begin(const RaySinkLayout& layout) override;
  void write(std::span<const AccountedRay> rays) override;
  void finish() override { file_.finish(); }

 private:
  AtomicFileWriter file_;
  RaySinkLayout layout_;
};

}  // namespace retrace::studies
