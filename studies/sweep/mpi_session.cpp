#include "studies/sweep/mpi_session.h"

#include <fmt/format.h>
#include <mpi.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <thread>
#include <utility>

#include "raytrace/threads.h"

namespace retrace::studies {
namespace {

using Clock = std::chrono::steady_clock;
using Json = nlohmann::json;

constexpr std::chrono::microseconds kPoll{100};
constexpr std::chrono::milliseconds kHeartbeat{500};
/// A rank of which nothing is heard for so long is given up.
constexpr std::chrono::seconds kSilence{15};
/// So long rank 0 waits for the others to leave after an interrupt or an error.
constexpr std::chrono::seconds kPatience{10};
constexpr std::chrono::milliseconds kWaitForOthers{50};

enum Tag : int {
  ask = 1,  ///< to rank 0: how many points are wanted
  result,   ///< to rank 0: a finished point
  alive,    ///< to rank 0: still at work
  leaving,  ///< to rank 0: gone after this, and why
  deal      ///< from rank 0: numbers of points; none: there is no more
};

std::string to_message(const StoredPoint& point) {
  Json outputs = Json::array();
  for (const StoredOutput& output : point.outputs)
    outputs.push_back(output.value ? Json{*output.value, output.std_error} : Json());
  return Json{{"point", point.point}, {"failed", point.failed},       {"reason", point.reason},
              {"outputs", outputs},   {"elapsed_s", point.elapsed_s}, {"version", point.version}}
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// \param sweep tells the inputs, which need not travel
StoredPoint from_message(const std::string& message, const Sweep& sweep) {
  const Json json = Json::parse(message);
  StoredPoint point;
  point.point = json.at("point");
  point.failed = json.at("failed");
  point.reason = json.at("reason");
  point.elapsed_s = json.at("elapsed_s");
  point.version = json.at("version");
  for (const Json& output : json.at("outputs")) {
    StoredOutput stored;
    if (!output.is_null()) stored.value = output.at(0).get<double>();
    if (!output.is_null() && output.at(1).is_number()) stored.std_error = output.at(1).get<double>();
    point.outputs.push_back(stored);
  }
  for (const ParameterValue& value : sweep.values(point.point)) point.inputs.push_back(value.shown);
  return point;
}

struct Message {
  int rank = 0;
  int tag = 0;
  std::string bytes;
};

bool is_cancelled(const Cancellation* cancel) {
  return cancel != nullptr && cancel->requested();
}

}  // namespace

struct MpiSession::State {
  int rank = 0;
  int size = 1;
  std::mutex mutex;         ///< MPI is called by one thread at a time
  std::set<int> present;    ///< rank 0: the others that have not left
  bool lost_ranks = false;  ///< some were given up: MPI cannot be ended in order
  std::vector<std::string> remarks;
  std::map<int, Clock::time_point> heard;

  void send(int to, int tag, const std::string& bytes) {
    const std::lock_guard lock(mutex);
    MPI_Send(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, to, tag, MPI_COMM_WORLD);
  }

  /// A message that has come, if one has.
  std::optional<Message> receive() {
    const std::lock_guard lock(mutex);
    int is_there = 0;
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &is_there, &status);
    if (is_there == 0) return std::nullopt;
    int size_of_message = 0;
    MPI_Get_count(&status, MPI_BYTE, &size_of_message);
    Message message{status.MPI_SOURCE, status.MPI_TAG, std::string(static_cast<std::size_t>(size_of_message), '\0')};
    MPI_Recv(message.bytes.data(), size_of_message, MPI_BYTE, message.rank, message.tag, MPI_COMM_WORLD,
             MPI_STATUS_IGNORE);
    return message;
  }

  void send_points(int to, const std::vector<std::uint64_t>& points) {
    send(to, Tag::deal,
         std::string(reinterpret_cast<const char*>(points.data()), points.size() * sizeof(std::uint64_t)));
  }

  /// Whoever asks is sent away, until nobody is left or patience ends. \param on_result takes what was still finished
  template <class OnResult>
  void dismiss(OnResult on_result) {
    const auto deadline = Clock::now() + kPatience;
    while (!present.empty() && Clock::now() < deadline) {
      const std::optional<Message> message = receive();
      if (!message) {
        std::this_thread::sleep_for(kPoll);
        continue;
      }
      if (message->tag == Tag::result) on_result(message->bytes);
      if (message->tag == Tag::ask) send_points(message->rank, {});
      if (message->tag == Tag::ask || message->tag == Tag::leaving) present.erase(message->rank);
    }
    lost_ranks = lost_ranks || !present.empty();
    present.clear();
  }
};

bool MpiSession::is_launched() {
  const auto is_set = [](const char* name) { return std::getenv(name) != nullptr; };
  return is_set("OMPI_COMM_WORLD_SIZE") || is_set("PMIX_RANK") || is_set("PMI_RANK");
}

MpiSession::MpiSession() : state_(std::make_unique<State>()) {
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &state_->rank);
  MPI_Comm_size(MPI_COMM_WORLD, &state_->size);
  // A rank that dies must not take this one along.
  MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
  if (state_->rank != 0) return;
  for (int other = 1; other < state_->size; ++other) {
    state_->present.insert(other);
    state_->heard[other] = Clock::now();
  }
}

MpiSession::~MpiSession() {
  if (state_->rank == 0) state_->dismiss([](const std::string&) {});
  // With ranks gone astray MPI would wait for them for ever.
  if (!state_->lost_ranks) MPI_Finalize();
}

int MpiSession::rank() const {
  return state_->rank;
}

std::vector<std::string> MpiSession::remarks() const {
  return state_->remarks;
}

namespace {

/// Points to be dealt and who has which. Safe to call from the thread that deals and those that compute.
class Dealer {
 public:
  Dealer(const Sweep& sweep, ResultStore& store, SweepObserver* observer)
      : sweep_(sweep), store_(store), count_(sweep, store, observer) {
    refill();
  }

  /// Points for a rank, claimed in the store.
  std::vector<std::uint64_t> take(int rank, std::size_t wanted) {
    const std::lock_guard lock(mutex_);
    std::vector<std::uint64_t> points;
    while (points.size() < wanted && !open_.empty()) {
      const std::uint64_t point = open_.front();
      open_.pop_front();
      if (!store_.claim(point)) continue;
      points.push_back(point);
      dealt_[point] = rank;
    }
    return points;
  }

  void record(const StoredPoint& point) {
    const std::lock_guard lock(mutex_);
    store_.record(point);
    if (dealt_.erase(point.point) > 0) count_.finished(point.failed);
  }

  /// What was dealt to a rank is to be dealt again.
  void take_back(int rank) {
    const std::lock_guard lock(mutex_);
    for (auto entry = dealt_.begin(); entry != dealt_.end();) {
      if (entry->second != rank) {
        ++entry;
        continue;
      }
      store_.give_up(entry->first);
      open_.push_front(entry->first);
      entry = dealt_.erase(entry);
    }
  }

  bool nothing_open() {
    const std::lock_guard lock(mutex_);
    return open_.empty();
  }

  /// Whether every point is finished; looks again at what other processes have taken.
  bool finished() {
    const std::lock_guard lock(mutex_);
    if (!open_.empty() || !dealt_.empty()) return false;
    if (store_.claimed_by_others() > 0) std::this_thread::sleep_for(kWaitForOthers);
    refill();
    return open_.empty();
  }

 private:
  void refill() {
    const std::vector<std::uint64_t> open = unfinished(sweep_, store_);
    open_.assign(open.begin(), open.end());
  }

  const Sweep& sweep_;
  ResultStore& store_;
  SweepCount count_;
  std::mutex mutex_;
  std::deque<std::uint64_t> open_;
  std::map<std::uint64_t, int> dealt_;
};

/// Rank 0's own share of the work, on a thread beside the one that deals. What goes wrong is kept for that one.
class OwnShare {
 public:
  OwnShare(const Sweep& sweep, Dealer& dealer, std::size_t slots, const Cancellation* cancel)
      : thread_([this, &sweep, &dealer, slots, cancel] {
          try {
            work(sweep, dealer, slots, cancel);
          } catch (...) {
            error_ = std::current_exception();
            failed_ = true;
          }
        }) {}
  ~OwnShare() {
    stop_ = true;
    thread_.join();
  }

  void rethrow() const {
    if (failed_) std::rethrow_exception(error_);
  }

 private:
  void work(const Sweep& sweep, Dealer& dealer, std::size_t slots, const Cancellation* cancel) {
    while (!stop_ && !is_cancelled(cancel)) {
      const std::vector<std::uint64_t> points = dealer.take(0, slots);
      if (points.empty()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      raytrace::for_each_in_parallel(points.size(), [&](std::size_t k) {
        const auto point = compute_point(sweep.study(), points[k], sweep.values(points[k]), cancel);
        if (point) dealer.record(*point);
      });
    }
    dealer.take_back(0);
  }

  std::atomic<bool> stop_{false};
  std::atomic<bool> failed_{false};
  std::exception_ptr error_;
  std::thread thread_;  ///< last: it uses the others
};

/// Ranks that wait for points, with how many they want.
using Waiting = std::map<int, std::size_t>;

}  // namespace

bool MpiSession::deal(const Sweep& sweep, ResultStore& store, std::size_t slots, SweepObserver* observer,
                      const Cancellation* cancel) {
  State& state = *state_;
  Dealer dealer(sweep, store, observer);
  const OwnShare own(sweep, dealer, slots, cancel);
  Waiting waiting;
  const auto lose = [&](int rank, const std::string& why) {
    dealer.take_back(rank);
    state.present.erase(rank);
    waiting.erase(rank);
    state.remarks.push_back(fmt::format("rank {} {}; its points went to others", rank, why));
  };
  while (!is_cancelled(cancel)) {
    own.rethrow();
    bool idle = true;
    while (const std::optional<Message> message = state.receive()) {
      idle = false;
      state.heard[message->rank] = Clock::now();
      if (message->tag == Tag::ask) waiting[message->rank] = std::stoul(message->bytes);
      if (message->tag == Tag::result) dealer.record(from_message(message->bytes, sweep));
      if (message->tag == Tag::leaving) lose(message->rank, "left: " + message->bytes);
    }
    for (auto entry = waiting.begin(); entry != waiting.end();) {
      const std::vector<std::uint64_t> points = dealer.take(entry->first, entry->second);
      if (points.empty()) break;
      state.send_points(entry->first, points);
      entry = waiting.erase(entry);
    }
    const std::set<int> present = state.present;
    for (const int rank : present)
      if (Clock::now() - state.heard[rank] > kSilence) {
        lose(rank, fmt::format("was silent for {} s", kSilence.count()));
        state.lost_ranks = true;
      }
    if (dealer.nothing_open() && dealer.finished()) break;
    if (idle) std::this_thread::sleep_for(kPoll);
  }
  for (const auto& [rank, wanted] : waiting) {
    state.send_points(rank, {});
    state.present.erase(rank);
  }
  state.dismiss([&](const std::string& message) { dealer.record(from_message(message, sweep)); });
  return unfinished(sweep, store).empty();
}

void MpiSession::serve(const Sweep& sweep, std::size_t slots, const Cancellation* cancel) {
  State& state = *state_;
  // A point may take long; rank 0 is to know that this one is at work.
  const std::jthread heart([&](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      state.send(0, Tag::alive, "");
      for (int k = 0; k < 10 && !stop.stop_requested(); ++k) std::this_thread::sleep_for(kHeartbeat / 10);
    }
  });
  while (true) {
    state.send(0, Tag::ask, std::to_string(slots));
    std::optional<Message> message;
    while (!(message = state.receive())) std::this_thread::sleep_for(kPoll);
    std::vector<std::uint64_t> points(message->bytes.size() / sizeof(std::uint64_t));
    std::copy(message->bytes.begin(), message->bytes.end(), reinterpret_cast<char*>(points.data()));
    if (points.empty()) return;
    raytrace::for_each_in_parallel(points.size(), [&](std::size_t k) {
      const auto point = compute_point(sweep.study(), points[k], sweep.values(points[k]), cancel);
      if (point) state.send(0, Tag::result, to_message(*point));
    });
    if (is_cancelled(cancel)) {
      leave("interrupted");
      return;
    }
  }
}

void MpiSession::leave(const std::string& why) {
  state_->send(0, Tag::leaving, why);
}

}  // namespace retrace::studies
