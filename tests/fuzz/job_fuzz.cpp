// For any text, the reader either returns a job or throws an InputError of one line. A job can be written and read back
// unchanged.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/error.h"
#include "fabrication/job/io/job_files.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  namespace fabrication = retrace::fabrication;
  try {
    const auto job = fabrication::parse_job({reinterpret_cast<const char*>(data), size}, "fuzz.toml");
    const std::string text = fabrication::job_text(job);
    if (fabrication::job_text(fabrication::parse_job(text, "fuzz.toml")) != text) std::abort();
  } catch (const retrace::InputError& error) {
    const std::string_view message = error.what();
    const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20; };
    if (message.empty() || std::any_of(message.begin(), message.end(), is_control)) std::abort();
  }
  return 0;
}
