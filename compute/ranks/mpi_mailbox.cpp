#include "compute/ranks/mpi_mailbox.h"

#include "core/module.h"

namespace retrace::compute {

std::unique_ptr<MpiMailbox> open_mpi_mailbox(std::chrono::milliseconds sign_of_life) {
  // The module is loaded with global symbols, because OpenMPI loads components that use symbols of its libraries
  // without being linked to these libraries.
  static constexpr Module module{.name = "retrace_mpi",
                                 .function = "retrace_mpi_mailbox",
                                 .missing_message = "the ranks started by mpirun or srun cannot communicate",
                                 .library = "OpenMPI",
                                 .package = "openmpi-bin",
                                 .is_global = true};
  using Open = void (*)(std::chrono::milliseconds sign_of_life, std::unique_ptr<MpiMailbox> & mailbox);
  const auto open = reinterpret_cast<Open>(module_function(module));
  std::unique_ptr<MpiMailbox> mailbox;
  open(sign_of_life, mailbox);
  return mailbox;
}

}  // namespace retrace::compute
