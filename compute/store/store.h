#pragma once

// Stores the results of a study point by point in an SQLite database, so that an interrupted run can be resumed.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace retrace::compute {

/// Stored value of a parameter: a number, or a text for values of other types.
using StoredValue = std::variant<double, std::string>;

/// Stored value of a quantity at a point. The value is missing if the quantity is not defined at this point.
struct StoredOutput {
  std::optional<double> value;
  double std_error = 0.0;
};

/// Finished point of a study. Its computation has either succeeded, or failed for a reason that would occur again in a
/// repetition.
struct StoredPoint {
  std::uint64_t point = 0;
  bool failed = false;
  std::string reason;                 ///< error message if the computation failed; otherwise empty
  std::vector<StoredValue> inputs;    ///< in the order of StoreLayout::inputs
  std::vector<StoredOutput> outputs;  ///< in the order of StoreLayout::outputs; empty if the computation failed
  double elapsed_s = 0.0;
  std::string version;  ///< version of the program that computed the point
};

/// Description of the contents of a store. An existing file is compared with it, and the store of another study is
/// refused.
struct StoreLayout {
  std::string kind;    ///< kind of the store, such as "retrace.sweep/1"
  std::string source;  ///< name of the study file, for messages
  /// Parts of the study, each with a name and a canonical text. A store with other parts belongs to another study.
  std::vector<std::pair<std::string, std::string>> parts;
  std::vector<std::string> inputs;
  std::vector<std::string> outputs;
  /// Function that checks the number and the inputs of a point against the study. It returns an error message, or an
  /// empty text if the point is valid. Every point that is read from a file is checked.
  std::function<std::string(const StoredPoint& point)> fault_of = {};
};

enum class IfExists { refuse, resume, overwrite };

/// Finished points in one SQLite file. Every point is committed separately, so that a killed process loses no finished
/// points. Several processes on one machine may use one file. A process claims points before it computes them, so that
/// no other process computes them. Claims of dead processes are void. Several threads may use the same object.
class ResultStore {
 public:
  /// \param file name of an SQLite file; if it is empty, the store is in memory, and only this process can access it
  /// \throw InputError if the file exists and `if_exists` is `refuse`. A store in which no point has succeeded is
  ///     replaced instead. Also thrown if another process uses a file that is to be replaced. Also thrown if the file
  ///     is damaged, is not a store, belongs to another study or has a newer format. Nothing is written in any of these
  ///     cases
  /// \throw OutputError if the file cannot be written
  ResultStore(const std::filesystem::path& file, const StoreLayout& layout, IfExists if_exists);
  ~ResultStore();
  ResultStore(const ResultStore&) = delete;
  ResultStore& operator=(const ResultStore&) = delete;

  /// Claims a point for this process. Returns false if the point is finished or claimed by another living process.
  /// \throw OutputError in the same cases as record()
  bool claim(std::uint64_t point);
  /// Gives up a claim, so that another process may compute the point.
  void give_up(std::uint64_t point);
  /// Stores a finished point and ends its claim. A point that is already stored is not changed.
  /// \throw OutputError if the point cannot be written, for example because the disk is full; stored points are kept
  void record(const StoredPoint& point);

  /// Deletes the claims of dead processes.
  /// \return number of points that other living processes have claimed
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

}  // namespace retrace::compute
