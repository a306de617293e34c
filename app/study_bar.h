#pragma once

// Progress bar for searches of the best design, and advice for shorter studies.

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

#include "app/progress_bar.h"
#include "studies/optimise/optimise.h"
#include "studies/sweep/sweep.h"

namespace retrace::app {

/// Minimum time between two lines about intermediate results.
inline constexpr std::chrono::seconds kTimeBetweenLines{5};

/// Returns advice for a shorter study, such as "give a smaller analysis.samples (now 1000000000)".
/// \param fewer_points additional advice on how to reduce the number of points, such as "give fewer values"; may be
///        empty
Words to_shorten_study(const studies::Study& study, const std::string& fewer_points);

/// Progress bar of a search that evaluates an unknown number of designs.
class SearchBar : public studies::OptimiseObserver, public studies::SweepObserver {
 public:
  /// \param of plural noun for the counted items, such as "designs"
  SearchBar(RunText text, std::string of, const CommonOptions& common);

  /// Reports the progress of the first group of designs if several MPI processes compute it together.
  void at(std::uint64_t done, std::uint64_t total, std::uint64_t failed) override;
  void at_fraction(double fraction) override;
  void at(std::size_t evaluated) override;
  /// Shows the best design so far. A terminal shows it next to the number of designs; other outputs receive a line from
  /// time to time. Then calls the function that on_best() has set.
  void at_best(const studies::Variant& best) override;
  /// Sets a function that describes a design in one line, and a function that is called for each new best design.
  void on_best(std::function<std::string(const studies::Variant&)> text,
               std::function<void(const studies::Variant&)> action);
  void at_group(double fraction, std::size_t designs) override;

 private:
  /// Writes a line about the best design if it has changed and the last line is old enough.
  void write_best();

  ProgressBar bar_;
  std::string of_;
  std::function<std::string(const studies::Variant&)> text_of_best_;
  std::function<void(const studies::Variant&)> at_best_;
  std::string best_;     ///< text about the best design so far; empty if there is none
  bool is_new_ = false;  ///< true if no line about the best design has been written yet
  std::chrono::steady_clock::time_point last_line_ = std::chrono::steady_clock::now();
  std::uint64_t first_group_ = 0;  ///< number of designs in the first group; 0 until it is known
};

}  // namespace retrace::app
