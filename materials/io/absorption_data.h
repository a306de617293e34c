#pragma once

// Collects the samples of absorption in a data file. Samples that cannot be used cause warnings instead of errors,
// because the refractive index in the same file does not depend on them.

#include <string>
#include <string_view>
#include <vector>

#include "materials/dispersion.h"

namespace retrace::materials {

/// Samples of absorption over wavelength, which are added one by one while a file is read.
class AbsorptionData {
 public:
  /// \param file name of the file, for warnings
  /// \param key name of the record or key that contains the samples, for warnings
  AbsorptionData(std::string file, std::string key) : file_(std::move(file)), key_(std::move(key)) {}

  /// Adds a sample.
  /// \param line line of the file
  /// \param per_mm Napierian absorption coefficient of the power, >= 0
  void add(int line, double wavelength_nm, double per_mm) { samples_.push_back({line, wavelength_nm, per_mm}); }
  /// Adds a sample with the absorption 0. It is used if measurement noise has moved the value in the file slightly out
  /// of the allowed range.
  /// \param reason text for the warning: the allowed values and the given value
  void add_zero(int line, double wavelength_nm, std::string_view reason);
  /// Counts a sample that cannot be used. The sample is omitted.
  /// \param reason text for the warning: the allowed values and the given value
  void omit(int line, std::string_view reason);

  /// Sets the absorption of `material` and adds the warnings. Repeated equal samples count as one sample. If samples at
  /// the same wavelength have different values, all of them are omitted.
  void finish(Material& material);

 private:
  struct Sample {
    int line = 0;
    double wavelength_nm = 0.0;
    double per_mm = 0.0;
  };
  /// Samples that cause the same warning: their number, and the line and reason of the first sample.
  struct Defects {
    int count = 0;
    int line = 0;
    std::string reason;

    void add(int at_line, std::string_view why);
  };

  void warn(const Defects& blemishes, std::string_view one, std::string_view several, Material& material) const;

  std::string file_;
  std::string key_;
  std::vector<Sample> samples_;
  Defects zeros_;
  Defects omitted_;
};

}  // namespace retrace::materials
