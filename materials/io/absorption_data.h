#pragma once

// Collects the samples of absorption that a data file contains. Samples that cannot be used cause only warnings,
// because the refractive index in the same file does not depend on them.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "materials/dispersion.h"

namespace retrace::materials {

/// Samples of absorption over wavelength that are read from a file one by one.
class AbsorptionData {
 public:
  /// \param file name of the file, for warnings
  /// \param key name of the record or key that contains the samples, for warnings
  AbsorptionData(std::string file, std::string key) : file_(std::move(file)), key_(std::move(key)) {}

  /// Adds a sample.
  /// \param line line of the file
  /// \param per_mm Napierian absorption coefficient of the power, >= 0
  void add(int line, double wavelength_nm, double per_mm) { samples_.push_back({line, wavelength_nm, per_mm}); }
  /// Adds a sample with the absorption 0. The value in the file is slightly beyond its bound because of measurement
  /// noise.
  /// \param reason text for the warning: the allowed values and the given value
  void add_zero(int line, double wavelength_nm, std::string_view reason);
  /// Counts a sample that cannot be used and is left out.
  /// \param reason text for the warning: the allowed values and the given value
  void leave_out(int line, std::string_view reason);

  /// Sets the absorption of `material` and adds the warnings. Equal samples count as one sample. Samples with different
  /// values at the same wavelength are left out.
  void finish(Material& material);

 private:
  struct Sample {
    int line = 0;
    double wavelength_nm = 0.0;
    double per_mm = 0.0;
  };
  /// Number of samples that cause the same warning, with the line and the reason of the first of these samples.
  struct Blemishes {
    int count = 0;
    int line = 0;
    std::string reason;

    void add(int at_line, std::string_view why);
  };

  void warn(const Blemishes& blemishes, std::string_view one, std::string_view several, Material& material) const;

  std::string file_;
  std::string key_;
  std::vector<Sample> samples_;
  Blemishes zeros_;
  Blemishes left_out_;
};

}  // namespace retrace::materials
