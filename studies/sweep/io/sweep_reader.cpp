#include "studies/sweep/io/sweep_reader.h"

#include <fmt/format.h>

#include <utility>

namespace retrace::studies {

Sweep read_sweep(Study study) {
  const schema::Document& document = *study.document;
  const auto combine = document.choice<Combine>("sweep.combine");
  const double samples = document.number_if("sweep.samples").value_or(0.0);
  if (samples > 0.0 && study.parameters.size() > compute::UnitSamples::max_dimensions)
    document.fail("sweep.combine",
                  fmt::format("is allowed only for up to {} parameters", compute::UnitSamples::max_dimensions));
  return {std::move(study), combine, static_cast<std::uint64_t>(samples)};
}

}  // namespace retrace::studies
