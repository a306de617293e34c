#pragma once

// Traces light at all wavelengths of a spectrum, with independent random numbers for each wavelength.

#include <cstddef>
#include <cstdint>
#include <functional>

#include "core/task_progress.h"
#include "raytrace/sampling/replicates.h"

namespace retrace::raytrace {

/// Returns the random seed for one wavelength of a spectrum. Different wavelengths have different seeds, so that their
/// estimates are independent. The seed of the first wavelength is `seed`.
std::uint32_t seed_at(std::uint32_t seed, std::size_t wavelength);

/// Returns the sampling parameters for one wavelength of a spectrum. The N rays of a request are distributed over the
/// wavelengths in proportion to the weights w of the wavelengths. If one ray has the variance v, the estimate at one
/// wavelength has the variance v / (w N). It contributes w^2 v / (w N) = w v / N to the variance of the mean. The sum
/// over all wavelengths is v / N, as for N rays at a single wavelength. The target error t becomes t / sqrt(w)
/// accordingly.
/// \param all sampling parameters for the mean over the spectrum
Sampling sampling_at(Sampling all, double weight, std::size_t wavelength);

/// Calls trace(direction, wavelength, progress) for each combination of a direction and a wavelength.
/// \param in_parallel true: several combinations are traced at the same time, within the memory limit of
/// for_each_within_memory(); false: one after the other, each with all threads
/// \param trace returns false if tracing was cancelled; combinations that have not begun are then omitted unless they
/// are traced in parallel
/// \return false if tracing was cancelled
bool trace_wavelengths(std::size_t directions, std::size_t wavelengths, bool in_parallel, TaskProgress& all,
                       const std::function<bool(std::size_t, std::size_t, Progress&)>& trace);

}  // namespace retrace::raytrace
