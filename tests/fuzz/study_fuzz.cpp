// For any study file, every command either accepts the file or refuses it with a message of one line. The design of the
// study is in a temporary folder. Quantities are not computed.

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <string>

#include "core/error.h"
#include "studies/compose/io/compose_reader.h"
#include "studies/optimise/io/optimise_reader.h"
#include "studies/quantity/io/study_reader.h"
#include "studies/sweep/io/sweep_reader.h"
#include "studies/tolerance/io/tolerance_reader.h"
#include "tests/fuzz/one_line.h"

namespace {

using namespace retrace;

template <class Work>
void refused_in_one_line(Work work) {
  try {
    work();
  } catch (const InputError& error) {
    retrace::fuzz::require_one_line(error);
  }
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  std::string folder = "/tmp/retrace_study_fuzz_XXXXXX";
  if (::mkdtemp(folder.data()) == nullptr || ::chdir(folder.c_str()) != 0) std::abort();
  std::ofstream("d.toml") << "[element]\nkind = \"rtp\"\nbase_mm = 1\nwidth_mm = 1\n[array]\nx_length_mm = 10\n"
                             "y_length_mm = 10\n[body]\nthickness_mm = 2\nrefractive_index = 1.4917\n";
  std::ofstream("l.csv") << "standard,class,colour,observation_deg,v_deg,h_deg,minimum,unit,status\n"
                            "S,,white,0.2,0,0,1,mcd/lx,read\n";
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  // Skip texts that contain a path, because a file outside of the folder may be infinite, such as a device.
  if (text.find('/') != std::string::npos || text.find('\\') != std::string::npos) return 0;
  refused_in_one_line([&] {
    const studies::Study study = studies::parse_study(text, "study.toml");
    refused_in_one_line([&] {
      const studies::Sweep sweep = studies::read_sweep(study);
      if (sweep.size() == 0) std::abort();
      refused_in_one_line([&] { studies::make_candidate(study, sweep.values(sweep.size() - 1)); });
    });
    refused_in_one_line([&] { studies::read_optimise(study); });
    refused_in_one_line([&] { studies::read_compose(study); });
    refused_in_one_line([&] {
      const studies::ToleranceRequest request = studies::read_tolerance(study);
      if (request.samples <= 1000) studies::TolerancePlan(study, request).values(0);
    });
  });
  return 0;
}
