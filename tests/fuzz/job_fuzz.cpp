// For any text, the reader either returns a job or throws an InputError of one line. A job can be written and read back
// unchanged.

#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "core/error.h"
#include "fabrication/job/io/job_files.h"
#include "tests/fuzz/one_line.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  namespace fabrication = retrace::fabrication;
  try {
    const auto job = fabrication::parse_job({reinterpret_cast<const char*>(data), size}, "fuzz.toml");
    const std::string text = fabrication::job_text(job);
    if (fabrication::job_text(fabrication::parse_job(text, "fuzz.toml")) != text) std::abort();
  } catch (const retrace::InputError& error) {
    retrace::fuzz::require_one_line(error);
  }
  return 0;
}
