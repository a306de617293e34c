// Loadable module for MPI. The program loads it only if mpirun or srun launched the program. Only this file uses MPI.

#include <mpi.h>

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <list>
#include <mutex>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "compute/ranks/mpi_mailbox.h"

namespace retrace::compute {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::microseconds kPoll{100};
constexpr int kSignOfLife = 0;

/// Message that is being transferred. Its bytes must not move in memory until MPI has finished the transfer.
struct Transfer {
  MPI_Request request = MPI_REQUEST_NULL;
  int rank = 0;
  int tag = 0;
  std::string bytes;
};

bool is_done(Transfer& transfer) {
  int done = 0;
  MPI_Test(&transfer.request, &done, MPI_STATUS_IGNORE);
  return done != 0;
}

/// State that the mailbox shares with the thread that calls MPI.
struct MailboxState {
  std::chrono::milliseconds sign_of_life{500};

  // Shared members, protected by the mutex.
  mutable std::mutex mutex;
  std::condition_variable changed;
  bool started = false;
  bool closing = false;
  bool abandoned = false;
  bool ended = false;
  int rank = 0;
  int size = 1;
  std::deque<MpiMessage> posted;  ///< messages that wait to be sent; `rank` is the receiver
  std::deque<MpiMessage> arrived;
  bool sending = false;  ///< true while messages are being sent
  std::set<int> forgotten;
  std::vector<Clock::time_point> heard;

  // Members that are used only by the thread that makes the MPI calls. The transfers are stored in lists because MPI
  // stores addresses of their elements.
  std::list<Transfer> outgoing;
  std::list<Transfer> incoming;
  std::list<Transfer> given_up;  ///< transfers of forgotten ranks; MPI may access their memory until the process ends
  Clock::time_point told_last;

  void run();

 private:
  void start();
  bool send_posted();
  bool receive();
  void tell_signs_of_life();
  void send(int to, int tag, std::string bytes);
  void give_up_forgotten();
};

void MailboxState::start() {
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  // The death of another rank must not end this rank.
  MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
  int own_rank = 0;
  int ranks = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &own_rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  const std::lock_guard lock(mutex);
  rank = own_rank;
  size = ranks;
  heard.assign(static_cast<std::size_t>(ranks), Clock::now());
  started = true;
  changed.notify_all();
}

void MailboxState::send(int to, int tag, std::string bytes) {
  Transfer& transfer = outgoing.emplace_back(Transfer{MPI_REQUEST_NULL, to, tag, std::move(bytes)});
  MPI_Isend(transfer.bytes.data(), static_cast<int>(transfer.bytes.size()), MPI_BYTE, to, tag, MPI_COMM_WORLD,
            &transfer.request);
}

bool MailboxState::send_posted() {
  std::deque<MpiMessage> letters;
  {
    const std::lock_guard lock(mutex);
    letters.swap(posted);
    sending = sending || !letters.empty();
  }
  for (MpiMessage& letter : letters) send(letter.rank, letter.tag, std::move(letter.bytes));
  outgoing.remove_if(is_done);
  if (outgoing.empty()) {
    const std::lock_guard lock(mutex);
    sending = !posted.empty();
    changed.notify_all();
  }
  return !letters.empty();
}

/// Receives messages that have arrived. Receiving a long message may need several calls.
/// \return true if at least one message has been received completely
bool MailboxState::receive() {
  for (;;) {
    int is_there = 0;
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &is_there, &status);
    if (is_there == 0) break;
    int bytes = 0;
    MPI_Get_count(&status, MPI_BYTE, &bytes);
    Transfer& transfer = incoming.emplace_back(Transfer{MPI_REQUEST_NULL, status.MPI_SOURCE, status.MPI_TAG,
                                                        std::string(static_cast<std::size_t>(bytes), '\0')});
    MPI_Irecv(transfer.bytes.data(), bytes, MPI_BYTE, transfer.rank, transfer.tag, MPI_COMM_WORLD, &transfer.request);
  }
  bool any = false;
  // Ranks whose next message is not complete. Later messages of these ranks wait, so that the order is kept.
  std::set<int> unfinished;
  for (auto transfer = incoming.begin(); transfer != incoming.end();) {
    if (unfinished.contains(transfer->rank) || !is_done(*transfer)) {
      unfinished.insert(transfer->rank);
      ++transfer;
      continue;
    }
    const std::lock_guard lock(mutex);
    heard[static_cast<std::size_t>(transfer->rank)] = Clock::now();
    if (transfer->tag != kSignOfLife) {
      arrived.push_back({transfer->rank, transfer->tag, std::move(transfer->bytes)});
      changed.notify_all();
    }
    transfer = incoming.erase(transfer);
    any = true;
  }
  return any;
}

void MailboxState::tell_signs_of_life() {
  const auto now = Clock::now();
  if (now - told_last < sign_of_life) return;
  told_last = now;
  std::vector<int> others;
  {
    const std::lock_guard lock(mutex);
    for (int other = 0; other < size; ++other)
      if (other != rank && (rank == 0 || other == 0) && !forgotten.contains(other)) others.push_back(other);
  }
  for (const int other : others) send(other, kSignOfLife, "");
}

void MailboxState::give_up_forgotten() {
  std::set<int> ranks;
  {
    const std::lock_guard lock(mutex);
    ranks = forgotten;
  }
  if (ranks.empty()) return;
  for (std::list<Transfer>* const list : {&outgoing, &incoming})
    for (auto transfer = list->begin(); transfer != list->end();) {
      const auto next = std::next(transfer);
      if (ranks.contains(transfer->rank)) given_up.splice(given_up.end(), *list, transfer);
      transfer = next;
    }
}

void MailboxState::run() {
  start();
  for (;;) {
    give_up_forgotten();
    const bool sent = send_posted();
    const bool received = receive();
    std::unique_lock lock(mutex);
    if (abandoned) break;
    if (closing && posted.empty() && outgoing.empty()) {
      lock.unlock();
      MPI_Finalize();
      break;
    }
    const bool tells = !closing;
    if (!sent && !received) changed.wait_for(lock, kPoll, [this] { return !posted.empty() || abandoned; });
    lock.unlock();
    if (tells) tell_signs_of_life();
  }
  const std::lock_guard lock(mutex);
  ended = true;
  changed.notify_all();
}

class Mailbox final : public MpiMailbox {
 public:
  explicit Mailbox(std::chrono::milliseconds sign_of_life) : state_(std::make_shared<MailboxState>()) {
    state_->sign_of_life = sign_of_life;
    // The thread is detached, because it could not be joined if MPI blocked it forever.
    std::thread([state = state_] { state->run(); }).detach();
  }

  ~Mailbox() override {
    std::unique_lock lock(state_->mutex);
    state_->abandoned = true;
    state_->changed.notify_all();
    state_->changed.wait_for(lock, std::chrono::seconds(1), [this] { return state_->ended; });
  }

  bool wait_for_start(std::chrono::milliseconds patience) override {
    std::unique_lock lock(state_->mutex);
    return state_->changed.wait_for(lock, patience, [this] { return state_->started; });
  }

  int rank() const override { return state_->rank; }
  int size() const override { return state_->size; }

  void post(int to, int tag, std::string bytes) override {
    const std::lock_guard lock(state_->mutex);
    if (state_->forgotten.contains(to)) return;
    state_->posted.push_back({to, tag, std::move(bytes)});
    state_->sending = true;
    state_->changed.notify_all();
  }

  std::optional<MpiMessage> take(std::chrono::microseconds patience) override {
    std::unique_lock lock(state_->mutex);
    if (!state_->changed.wait_for(lock, patience, [this] { return !state_->arrived.empty(); })) return std::nullopt;
    MpiMessage letter = std::move(state_->arrived.front());
    state_->arrived.pop_front();
    return letter;
  }

  std::chrono::duration<double> silence(int rank) const override {
    const std::lock_guard lock(state_->mutex);
    return Clock::now() - state_->heard.at(static_cast<std::size_t>(rank));
  }

  void reset_silence() override {
    const std::lock_guard lock(state_->mutex);
    std::fill(state_->heard.begin(), state_->heard.end(), Clock::now());
  }

  void drop_rank(int rank) override {
    const std::lock_guard lock(state_->mutex);
    state_->forgotten.insert(rank);
  }

  bool flush(std::chrono::milliseconds patience) override {
    std::unique_lock lock(state_->mutex);
    return state_->changed.wait_for(lock, patience, [this] { return !state_->sending; });
  }

  bool close(std::chrono::milliseconds patience) override {
    std::unique_lock lock(state_->mutex);
    state_->closing = true;
    state_->changed.notify_all();
    return state_->changed.wait_for(lock, patience, [this] { return state_->ended; });
  }

 private:
  std::shared_ptr<MailboxState> state_;  ///< shared with the thread, which can exist longer than this object
};

}  // namespace
}  // namespace retrace::compute

extern "C" __attribute__((visibility("default"))) void retrace_mpi_mailbox(
    std::chrono::milliseconds sign_of_life, std::unique_ptr<retrace::compute::MpiMailbox>& mailbox) {
  mailbox = std::make_unique<retrace::compute::Mailbox>(sign_of_life);
}
