#pragma once

// Internal to surface_models/: discrete Fourier transforms of real fields. This is the only interface to FFTW.

#include <complex>
#include <cstddef>
#include <memory>
#include <span>

namespace retrace::surface_models {

/// Returns the smallest number >= `min_length` whose only prime factors are 2, 3, 5 and 7. Transforms of such lengths
/// are fast.
/// \pre min_length >= 1
std::size_t fast_length(std::size_t min_length);

/// Real field of rows x columns and its transform F(j, k) = sum z(r, c) exp(-2 pi i (j r / rows + k c / columns)). Only
/// the columns 0..columns / 2 of the transform are stored. FFTW plans are estimated instead of timed, so that equal
/// fields give bitwise equal results.
class RealFft {
 public:
  RealFft(std::size_t rows, std::size_t columns);
  RealFft(const RealFft&) = delete;
  RealFft& operator=(const RealFft&) = delete;
  ~RealFft();

  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return columns_; }
  std::size_t spectrum_columns() const { return columns_ / 2 + 1; }

  std::span<double> field();                   ///< row by row; initially zero
  std::span<std::complex<double>> spectrum();  ///< row by row, with spectrum_columns() values each
  double& field(std::size_t column, std::size_t row) { return field()[row * columns_ + column]; }

  /// Computes the spectrum from the field. The field is preserved.
  void forward();
  /// Computes the field from the spectrum, scaled such that it is the inverse of forward(). The spectrum is
  /// overwritten.
  void inverse();

 private:
  struct Impl;
  std::size_t rows_;
  std::size_t columns_;
  std::unique_ptr<Impl> impl_;
};

}  // namespace retrace::surface_models
