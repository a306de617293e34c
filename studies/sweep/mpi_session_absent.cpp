// In place of mpi_session.cpp where retrace is built without MPI.

#include <cstdlib>

#include "core/error.h"
#include "studies/sweep/mpi_session.h"

namespace retrace::studies {

struct MpiSession::State {};

bool MpiSession::is_launched() {
  return std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr;
}

MpiSession::MpiSession() {
  throw InputError("this retrace was built without MPI (RETRACE_WITH_MPI=OFF): run it without mpirun");
}
MpiSession::~MpiSession() = default;

int MpiSession::rank() const {
  return 0;
}
bool MpiSession::deal(const ComputeTask&, TaskLedger&, std::size_t, const Cancellation*) {
  return false;
}
std::vector<std::string> MpiSession::remarks() const {
  return {};
}
void MpiSession::serve(const ComputeTask&, std::size_t, const Cancellation*) {}
void MpiSession::leave(const std::string&) {}
bool MpiSession::end() {
  return true;
}

}  // namespace retrace::studies
