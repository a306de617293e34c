#pragma once

// Results of a study point by point in an SQLite database, so that an interrupted run goes on where it was cut off.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace retrace::studies {

/// A value of a parameter as it is stored: a number, or the text of anything else.
using StoredValue = std::variant<double, std::string>;

/// What a quantity came to at a point. Nothing if it has no value there, such as a limit that does not exist.
struct StoredOutput {
  std::optional<double> value;
  double std_error = 0.0;
};

/// A finished point of a study: computed, or failed for a reason that doing it again would not change.
struct StoredPoint {
  std::uint64_t point = 0;
  bool failed = false;
  std::string reason;                 ///< why it failed; empty if it did not
  std::vector<StoredValue> inputs;    ///< in the order of StoreLayout::inputs
  std::vector<StoredOutput> outputs;  ///< in the order of StoreLayout::outputs; empty if it failed
  double elapsed_s = 0.0;
  std::string version;  ///< of the program that computed it
};

/// What a store holds. A store of another study is not taken for one of this.
struct StoreLayout {
  std::string kind;    ///< such as "retrace.sweep/1"
  std::string source;  ///< the study file, for messages
  /// The study in parts, each with a name and a canonical text. A store whose parts differ is of another study.
  std::vector<std::pair<std::string, std::string>> parts;
  std::vector<std::string> inputs;
  std::vector<std::string> outputs;
  /// Function that checks the number and the inputs of a point against the study. It returns an error message, or an
  /// empty text if the point is valid. Every point that is read from a file is checked.
  std::function<std::string(const StoredPoint& point)> fault_of = {};
};

enum class IfExists { refuse, resume, overwrite };

/// Finished points in one SQLite file. Every point is committed by itself: a process that is killed loses none. Several
/// processes of one machine may work on one file, each on the points that it has claimed; claims of a process that died
/// are void. Safe to call from several threads.
class ResultStore {
 public:
  /// \param file empty: the store is in memory and only this process can access it
  /// \throw InputError if the file exists although it must not, is no store, is damaged, belongs to another study or
  /// has a newer version. Nothing is written then.
  /// \throw OutputError if the file cannot be written
  ResultStore(const std::filesystem::path& file, const StoreLayout& layout, IfExists if_exists);
  ~ResultStore();
  ResultStore(const ResultStore&) = delete;
  ResultStore& operator=(const ResultStore&) = delete;

  /// Whether the point is this process's to compute: not finished and not claimed by another that lives.
  /// \throw OutputError as record()
  bool claim(std::uint64_t point);
  /// Gives a claim up, so that another process may take the point.
  void give_up(std::uint64_t point);
  /// Stores a finished point and ends its claim; a point that is stored already stays as it is.
  /// \throw OutputError if it cannot be written, as on a full disk; what is stored stays
  void record(const StoredPoint& point);

  /// Voids the claims of processes that died. \return how many points others still have claimed
  std::size_t claimed_by_others();
  /// Returns the numbers of the finished points in ascending order.
  /// \throw InputError if the file is damaged
  std::vector<std::uint64_t> finished() const;
  /// Returns all finished points in ascending order.
  /// \throw InputError if the file is damaged
  std::vector<StoredPoint> points() const;

 private:
  struct Database;
  std::unique_ptr<Database> database_;
};

}  // namespace retrace::studies
