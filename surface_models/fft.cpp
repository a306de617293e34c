#include "surface_models/fft.h"

#include <fftw3.h>

#include <algorithm>
#include <mutex>
#include <new>

namespace retrace::surface_models {
namespace {

struct Release {
  void operator()(void* memory) const { fftw_free(memory); }
};

/// Returns the mutex for FFTW's planner, which is the only part of FFTW that is not thread-safe.
std::mutex& planner() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace

std::size_t fast_length(std::size_t min_length) {
  for (std::size_t n = min_length;; ++n) {
    std::size_t rest = n;
    for (const std::size_t factor : {2U, 3U, 5U, 7U})
      while (rest % factor == 0) rest /= factor;
    if (rest == 1) return n;
  }
}

struct RealFft::Impl {
  std::unique_ptr<double, Release> field;
  std::unique_ptr<std::complex<double>, Release> spectrum;
  fftw_plan forward = nullptr;
  fftw_plan inverse = nullptr;
};

RealFft::RealFft(std::size_t rows, std::size_t columns)
    : rows_(rows), columns_(columns), impl_(std::make_unique<Impl>()) {
  const std::size_t half = rows_ * spectrum_columns();
  impl_->field.reset(fftw_alloc_real(rows_ * columns_));
  impl_->spectrum.reset(reinterpret_cast<std::complex<double>*>(fftw_alloc_complex(half)));
  if (!impl_->field || !impl_->spectrum) throw std::bad_alloc();
  auto* const spectrum_data = reinterpret_cast<fftw_complex*>(impl_->spectrum.get());
  const std::lock_guard lock(planner());
  // FFTW uses int for sizes. Maps are much smaller than its limit (kMaxPoints of the readers).
  const int n_rows = static_cast<int>(rows_);
  const int n_columns = static_cast<int>(columns_);
  impl_->forward = fftw_plan_dft_r2c_2d(n_rows, n_columns, impl_->field.get(), spectrum_data, FFTW_ESTIMATE);
  impl_->inverse = fftw_plan_dft_c2r_2d(n_rows, n_columns, spectrum_data, impl_->field.get(), FFTW_ESTIMATE);
  std::ranges::fill(field(), 0.0);
}

RealFft::~RealFft() {
  const std::lock_guard lock(planner());
  fftw_destroy_plan(impl_->forward);
  fftw_destroy_plan(impl_->inverse);
}

std::span<double> RealFft::field() {
  return {impl_->field.get(), rows_ * columns_};
}

std::span<std::complex<double>> RealFft::spectrum() {
  return {impl_->spectrum.get(), rows_ * spectrum_columns()};
}

void RealFft::forward() {
  fftw_execute(impl_->forward);
}

void RealFft::inverse() {
  fftw_execute(impl_->inverse);
  const double scale = 1.0 / static_cast<double>(rows_ * columns_);
  for (double& value : field()) value *= scale;
}

}  // namespace retrace::surface_models
