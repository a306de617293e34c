// Replaces FFTW. It is needed only for maps of measured surfaces, which are files that the live page cannot read.
#include "surface_models/fft.h"

#include "live/engine/stand_ins/absent.h"

namespace retrace::surface_models {

struct RealFft::Impl {};

std::size_t fast_length(std::size_t min_length) {
  return min_length;
}

RealFft::RealFft(std::size_t rows, std::size_t columns) : rows_(rows), columns_(columns) {
  live::fail_as_absent("no maps of surfaces");
}
RealFft::~RealFft() = default;
std::span<double> RealFft::field() {
  return {};
}
std::span<std::complex<double>> RealFft::spectrum() {
  return {};
}
void RealFft::forward() {}
void RealFft::inverse() {}

}  // namespace retrace::surface_models
