#include "compute/ranks/mpi_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string_view>
#include <thread>

#include "compute/ranks/mpi_mailbox.h"
#include "core/error.h"
#include "core/leading_number.h"
#include "core/message_text.h"
#include "core/threads.h"

namespace retrace::compute {
namespace {

using Clock = std::chrono::steady_clock;

/// Time without messages, in seconds, after which a rank (process of the job) is given up. The environment variable
/// kSilenceVariable overrides it.
constexpr double kSilenceS = 15.0;
constexpr const char* kSilenceVariable = "RETRACE_MPI_SILENCE_S";
/// Maximum time for the start of a job; large jobs start slowly.
constexpr std::chrono::minutes kStart{10};
/// Maximum time that rank 0 waits until the other ranks have left, and that every rank waits until MPI is finalized.
constexpr std::chrono::seconds kPatience{10};
// Maximum time that rank 0 waits for other ranks after an interrupt. It is short because an interrupt must take less
// than a second.
constexpr std::chrono::milliseconds kLastCall{500};
constexpr std::chrono::milliseconds kLook{20};
/// Limit of the computing time of a batch of tasks. If the last batch took less time, a rank requests the next batch
/// before it computes the current one.
constexpr std::chrono::seconds kQuick{1};

enum Tag : int {
  ask = 1,  ///< to rank 0: number of tasks that the sender requests
  result,   ///< to rank 0: index of a finished task, followed by its result
  leaving,  ///< to rank 0: the sender leaves; contains the reason
  deal,     ///< from rank 0: indices of the tasks to compute
  go        ///< from rank 0: there are no more tasks; contains whether all ranks can finalize MPI together
};
constexpr std::string_view kAllAreThere = "all";

std::string bytes_of_result(std::uint64_t task, const std::string& bytes) {
  return std::string(reinterpret_cast<const char*>(&task), sizeof task) + bytes;
}

/// Returns the time without messages after which a rank is given up.
/// \throw InputError if the environment variable is invalid
std::chrono::duration<double> silence_limit() {
  const char* const text = std::getenv(kSilenceVariable);
  if (text == nullptr) return std::chrono::duration<double>(kSilenceS);
  const std::optional<LeadingNumber> seconds = leading_number(text);
  if (!seconds || text[seconds->length] != '\0' || !(seconds->value >= 1.0 && seconds->value <= 86400.0))
    throw InputError(
        fmt::format("{}: must be a number of seconds from 1 to 86400, got {}", kSilenceVariable, in_quotes(text)));
  return std::chrono::duration<double>(seconds->value);
}

}  // namespace

struct MpiSession::State {
  std::chrono::duration<double> silence = silence_limit();
  std::unique_ptr<MpiMailbox> mailbox =
      open_mpi_mailbox(std::chrono::milliseconds(static_cast<long>(std::min(500.0, 1000.0 * silence.count() / 6.0))));
  std::set<int> there;      ///< rank 0: other ranks that have not been given up
  std::set<int> at_work;    ///< rank 0: ranks in `there` that have not announced that they are leaving
  bool lost_ranks = false;  ///< true: ranks were lost, so that MPI cannot be finalized
  bool may_go = false;      ///< other ranks: true if this rank may end, because rank 0 has sent `go` or is silent
  bool has_ended = false;
  bool ended_well = true;
  Warnings remarks;
  Clock::time_point looked_last = Clock::now();

  bool is_silent(int rank) const { return mailbox->silence(rank) > silence; }

  /// Ignores the silence of other ranks if this process itself was suspended or blocked for more than a second.
  void look() {
    const auto now = Clock::now();
    if (now - looked_last > std::chrono::seconds(1)) mailbox->reset_silence();
    looked_last = now;
  }

  void send_tasks(int to, const std::vector<std::uint64_t>& tasks) {
    mailbox->post(to, Tag::deal,
                  std::string(reinterpret_cast<const char*>(tasks.data()), tasks.size() * sizeof(std::uint64_t)));
  }

  void give_up(int rank) {
    there.erase(rank);
    at_work.erase(rank);
    lost_ranks = true;
    mailbox->drop_rank(rank);
  }

  void end_rank_0();
  void end_other();
};

/// Sends all ranks the message `go`, which allows them to end. Ranks that do not answer within kPatience are given up.
void MpiSession::State::end_rank_0() {
  for (const int rank : there) mailbox->post(rank, Tag::go, lost_ranks ? "" : std::string(kAllAreThere));
  const auto deadline = Clock::now() + kPatience;
  std::set<int> open = there;
  while (!open.empty() && Clock::now() < deadline) {
    const std::optional<MpiMessage> letter = mailbox->take(kLook);
    if (letter && letter->tag == Tag::leaving && letter->bytes.empty()) open.erase(letter->rank);
  }
  for (const int rank : open) give_up(rank);
}

void MpiSession::State::end_other() {
  while (!may_go) {
    look();
    const std::optional<MpiMessage> letter = mailbox->take(kLook);
    if (letter && letter->tag == Tag::go) {
      may_go = true;
      lost_ranks = letter->bytes != kAllAreThere;
    } else if (!letter && is_silent(0)) {
      may_go = true;
      lost_ranks = true;
    }
  }
  mailbox->post(0, Tag::leaving, "");
}

bool MpiSession::is_launched() {
  const auto is_set = [](const char* name) { return std::getenv(name) != nullptr; };
  return is_set("OMPI_COMM_WORLD_SIZE") || is_set("PMIX_RANK") || is_set("PMI_RANK");
}

MpiSession::MpiSession() : state_(std::make_unique<State>()) {
  if (!state_->mailbox->wait_for_start(kStart))
    throw BudgetError("MPI has not started within ten minutes; check that all ranks run");
  if (rank() != 0) return;
  for (int other = 1; other < state_->mailbox->size(); ++other) {
    state_->there.insert(other);
    state_->at_work.insert(other);
  }
}

MpiSession::~MpiSession() {
  end();
}

bool MpiSession::end() {
  State& state = *state_;
  if (state.has_ended) return state.ended_well;
  state.has_ended = true;
  if (rank() == 0)
    state.end_rank_0();
  else
    state.end_other();
  const bool has_gone = state.mailbox->flush(std::chrono::seconds(2));
  // MPI is not finalized if ranks were lost, because it would wait for them forever.
  state.ended_well = has_gone && !state.lost_ranks && state.mailbox->close(kPatience);
  return state.ended_well;
}

int MpiSession::rank() const {
  return state_->mailbox->rank();
}

Warnings MpiSession::remarks() const {
  return state_->remarks;
}

namespace {

std::vector<std::uint64_t> tasks_of(const std::string& bytes) {
  std::vector<std::uint64_t> tasks(bytes.size() / sizeof(std::uint64_t));
  std::memcpy(tasks.data(), bytes.data(), tasks.size() * sizeof(std::uint64_t));
  return tasks;
}

/// Assignment of a ledger's tasks to ranks. The thread that deals out tasks and the threads that compute tasks can call
/// its functions concurrently.
class TaskDistributor {
 public:
  explicit TaskDistributor(TaskLedger& ledger) : ledger_(ledger) {}

  /// Takes tasks from the ledger and assigns them to a rank.
  std::vector<std::uint64_t> take(int rank, std::size_t wanted) {
    const std::lock_guard lock(mutex_);
    std::vector<std::uint64_t> tasks;
    while (tasks.size() < wanted) {
      const std::optional<std::uint64_t> task = ledger_.take();
      if (!task) break;
      tasks.push_back(*task);
      dealt_[*task] = rank;
    }
    return tasks;
  }

  void finish(std::uint64_t task, const std::string& bytes) {
    const std::lock_guard lock(mutex_);
    if (dealt_.erase(task) > 0) ledger_.finish(task, bytes);
  }

  /// Returns the unfinished tasks of a rank to the ledger.
  void take_back(int rank) {
    const std::lock_guard lock(mutex_);
    for (auto entry = dealt_.begin(); entry != dealt_.end();) {
      if (entry->second != rank) {
        ++entry;
        continue;
      }
      ledger_.give_back(entry->first);
      entry = dealt_.erase(entry);
    }
  }

  /// Returns true if a rank has tasks whose results have not arrived.
  bool has_tasks(int rank) {
    const std::lock_guard lock(mutex_);
    return std::any_of(dealt_.begin(), dealt_.end(), [rank](const auto& entry) { return entry.second == rank; });
  }

  bool is_finished() {
    const std::lock_guard lock(mutex_);
    return dealt_.empty() && ledger_.is_finished();
  }

 private:
  TaskLedger& ledger_;
  std::mutex mutex_;
  std::map<std::uint64_t, int> dealt_;
};

/// Computes tasks on rank 0, in a second thread in addition to the thread that deals out tasks. Errors are stored until
/// the dealing thread calls rethrow().
class LocalWorker {
 public:
  LocalWorker(const ComputeTask& compute, TaskDistributor& dealer, std::size_t slots, const Cancellation* cancel)
      : thread_([this, &compute, &dealer, slots, cancel] {
          try {
            work(compute, dealer, slots, cancel);
          } catch (...) {
            error_ = std::current_exception();
            failed_ = true;
          }
        }) {}
  ~LocalWorker() {
    stop_ = true;
    thread_.join();
  }

  void rethrow() const {
    if (failed_) std::rethrow_exception(error_);
  }

 private:
  void work(const ComputeTask& compute, TaskDistributor& dealer, std::size_t slots, const Cancellation* cancel) {
    while (!stop_ && !is_cancelled(cancel)) {
      const std::vector<std::uint64_t> tasks = dealer.take(0, slots);
      if (tasks.empty()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      for_each_in_parallel(tasks.size(), [&](std::size_t k) {
        if (const auto bytes = compute(tasks[k], cancel)) dealer.finish(tasks[k], *bytes);
      });
    }
    dealer.take_back(0);
  }

  std::atomic<bool> stop_{false};
  std::atomic<bool> failed_{false};
  std::exception_ptr error_;
  std::thread thread_;  ///< last member, because the thread uses the other members
};

/// Ranks that wait for tasks, and the number of tasks that each of them has requested.
using Waiting = std::map<int, std::size_t>;

}  // namespace

bool MpiSession::distribute_tasks(const ComputeTask& compute, TaskLedger& ledger, std::size_t slots,
                                  const Cancellation* cancel) {
  State& state = *state_;
  TaskDistributor dealer(ledger);
  Waiting waiting;
  const auto leaves = [&](int rank, const std::string& why) {
    dealer.take_back(rank);
    state.at_work.erase(rank);
    waiting.erase(rank);
    state.remarks.push_back({"rank_lost", fmt::format("rank {} {}; other ranks compute its points", rank, why)});
  };
  const auto read = [&](const MpiMessage& letter) {
    if (!state.there.contains(letter.rank)) return;  // the rank was given up earlier, but it is alive
    if (letter.tag == Tag::ask) waiting[letter.rank] = std::stoul(letter.bytes);
    if (letter.tag == Tag::result)
      dealer.finish(tasks_of(letter.bytes.substr(0, sizeof(std::uint64_t))).front(),
                    letter.bytes.substr(sizeof(std::uint64_t)));
    if (letter.tag == Tag::leaving) leaves(letter.rank, "stopped: " + letter.bytes);
  };
  const auto give_up_silent = [&] {
    const std::set<int> there = state.there;
    for (const int rank : there) {
      if (!state.is_silent(rank)) continue;
      if (state.at_work.contains(rank)) leaves(rank, fmt::format("did not respond for {:g} s", state.silence.count()));
      state.give_up(rank);
    }
  };
  const auto deal_out = [&] {
    for (auto entry = waiting.begin(); entry != waiting.end();) {
      const std::vector<std::uint64_t> tasks = dealer.take(entry->first, entry->second);
      if (tasks.empty()) break;
      state.send_tasks(entry->first, tasks);
      entry = waiting.erase(entry);
    }
  };
  {
    const LocalWorker own(compute, dealer, slots, cancel);
    while (!is_cancelled(cancel)) {
      own.rethrow();
      state.look();
      if (const std::optional<MpiMessage> letter = state.mailbox->take(kLook)) read(*letter);
      deal_out();
      give_up_silent();
      if (dealer.is_finished()) return true;
    }
  }
  // After a cancellation, rank 0 waits a short time for the results of tasks that other ranks are still computing.
  const auto deadline = Clock::now() + kLastCall;
  const auto has_tasks = [&](int rank) { return dealer.has_tasks(rank); };
  while (std::any_of(state.at_work.begin(), state.at_work.end(), has_tasks) && Clock::now() < deadline)
    if (const std::optional<MpiMessage> letter = state.mailbox->take(kLook)) read(*letter);
  return dealer.is_finished();
}

void MpiSession::compute_tasks(const ComputeTask& compute, std::size_t slots, const Cancellation* cancel) {
  State& state = *state_;
  const auto ask = [&] { state.mailbox->post(0, Tag::ask, std::to_string(slots)); };
  ask();
  bool is_quick = false;
  while (!is_cancelled(cancel)) {
    state.look();
    const std::optional<MpiMessage> letter = state.mailbox->take(kLook);
    if (!letter && state.is_silent(0)) return;
    if (!letter) continue;
    if (letter->tag == Tag::go) {
      state.may_go = true;
      state.lost_ranks = letter->bytes != kAllAreThere;
      return;
    }
    const std::vector<std::uint64_t> tasks = tasks_of(letter->bytes);
    // If tasks are quick, the next batch is requested before this batch is computed, which hides the latency of
    // messages. If tasks are slow, the next batch is requested only when this rank is idle. Until then, rank 0 can deal
    // the remaining tasks to other idle ranks.
    if (is_quick) ask();
    const auto start = Clock::now();
    for_each_in_parallel(tasks.size(), [&](std::size_t k) {
      if (const auto bytes = compute(tasks[k], cancel))
        state.mailbox->post(0, Tag::result, bytes_of_result(tasks[k], *bytes));
    });
    if (!is_quick && !is_cancelled(cancel)) ask();
    is_quick = Clock::now() - start < kQuick;
    state.looked_last = Clock::now();
  }
  leave("interrupted");
}

void MpiSession::leave(const std::string& why) {
  state_->mailbox->post(0, Tag::leaving, why);
}

}  // namespace retrace::compute
