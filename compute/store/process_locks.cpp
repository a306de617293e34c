#include "compute/store/process_locks.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/error.h"

namespace retrace::compute {
namespace {

constexpr std::int64_t kMaxProcesses = 4096;

struct flock byte_lock(std::int64_t byte) {
  struct flock lock = {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  lock.l_start = byte;
  lock.l_len = 1;
  return lock;
}

}  // namespace

ProcessLocks::ProcessLocks(const std::filesystem::path& file)
    : descriptor_(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
  const auto fail = [&] {
    const OutputError error(file.string() + ": cannot be locked: " + std::strerror(errno));
    if (descriptor_ >= 0) ::close(descriptor_);
    throw error;
  };
  if (descriptor_ < 0) fail();
  for (; own_ < kMaxProcesses; ++own_) {
    struct flock lock = byte_lock(own_);
    // The locks F_OFD_... belong to the open file and not to the process. Therefore, they are not released when another
    // descriptor of the same file is closed.
    if (::fcntl(descriptor_, F_OFD_SETLK, &lock) == 0) return;
    if (errno != EAGAIN && errno != EACCES) fail();
  }
  fail();
}

ProcessLocks::~ProcessLocks() {
  ::close(descriptor_);
}

bool ProcessLocks::is_alive(std::int64_t owner) const {
  if (owner == own_) return true;
  if (owner < 0 || owner >= kMaxProcesses) return false;  // the lock file has only kMaxProcesses bytes
  struct flock lock = byte_lock(owner);
  return ::fcntl(descriptor_, F_OFD_GETLK, &lock) != 0 || lock.l_type != F_UNLCK;
}

}  // namespace retrace::compute
