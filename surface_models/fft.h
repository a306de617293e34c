#pragma once

// Private to surface_models/: discrete Fourier transforms of real fields, over FFTW, which no other file names.

#include <complex>
#include <cstddef>
#include <memory>
#include <span>

namespace retrace::surface_models {

/// The smallest number from `least` on whose only prime factors are 2, 3, 5 and 7: lengths that transform quickly.
/// \pre least >= 1
std::size_t fast_length(std::size_t least);

/// A real field of rows x columns and its transform, F(j, k) = sum z(r, c) exp(-2 pi i (j r / rows + k c / columns)),
/// of which the columns 0..columns / 2 are held. Plans are estimated, not timed, so the same field gives the same bits.
class RealFft {
 public:
  RealFft(std::size_t rows, std::size_t columns);
  RealFft(const RealFft&) = delete;
  RealFft& operator=(const RealFft&) = delete;
  ~RealFft();

  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return columns_; }
  std::size_t spectrum_columns() const { return columns_ / 2 + 1; }

  std::span<double> field();                   ///< row by row; zero at first
  std::span<std::complex<double>> spectrum();  ///< row by row, spectrum_columns() each
  double& field(std::size_t column, std::size_t row) { return field()[row * columns_ + column]; }

  /// Field to spectrum; keeps the field.
  void forward();
  /// Spectrum to field, scaled so that it undoes forward(); the spectrum is lost.
  void inverse();

 private:
  struct Hidden;
  std::size_t rows_;
  std::size_t columns_;
  std::unique_ptr<Hidden> hidden_;
};

}  // namespace retrace::surface_models
