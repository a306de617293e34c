#pragma once

// Absorption as data files give it. Blemishes of single samples are reported as warnings, because the refractive index
// in the same file is usable without them.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "materials/dispersion.h"

namespace retrace::materials {

/// Samples of absorption over wavelength that are read from a file one by one.
class AbsorptionData {
 public:
  /// \param file its name, for warnings \param key the record or key that holds the samples
  AbsorptionData(std::string file, std::string key) : file_(std::move(file)), key_(std::move(key)) {}

  /// Adds a sample. \param line of the file \param per_mm Napierian, for power, >= 0
  void add(int line, double wavelength_nm, double per_mm) { samples_.push_back({line, wavelength_nm, per_mm}); }
  /// Adds a sample whose value is noise of the measurement about 0, as 0. \param reason what is allowed and was given
  void add_zero(int line, double wavelength_nm, std::string_view reason);
  /// Leaves a sample out. \param reason what is allowed and was given
  void leave_out(int line, std::string_view reason);

  /// Sets the absorption of `material` and adds the warnings. Equal samples count one time; samples that differ at the
  /// same wavelength are left out.
  void finish(Material& material);

 private:
  struct Sample {
    int line = 0;
    double wavelength_nm = 0.0;
    double per_mm = 0.0;
  };
  /// Samples that are treated in the same way, and where the first of them is.
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
