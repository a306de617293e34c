#pragma once

// Moves of a planing mill that can only move one axis at a time, never less than a least distance, split into programs
// of limited time.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "fabrication/planing/part.h"
#include "fabrication/planing/plan/plan.h"

namespace retrace::fabrication {

/// Writes the moves of a planing mill: one axis at a time, on the grid, none shorter than the least. A shorter way is
/// made by a move back and another forth. Cuts programs so that none runs longer than the machine may.
class MillMoves {
 public:
  /// \throw InputError if strokes or heights do not fit the machine's travel
  MillMoves(const PlanedPart& part, std::string set);

  /// Lowers the tool to a depth, beside the part. Grid steps below the face.
  void lower_to(std::int64_t depth);
  void across_to(std::int64_t x);
  /// Along the zones and back.
  void stroke();
  /// Up, and back to the middle of the lens.
  void go_home();
  /// Moves that belong together: the next program begins before them if they would not end in time.
  /// \throw InputError if they alone take too long
  template <class Moves>
  void together(const Moves& moves) {
    const Mark before = mark();
    moves();
    if (ends_in_time()) return;
    go_back_to(before);
    begin_next();
    moves();
    require_in_time();
  }
  std::vector<PlannedProgram> finish();

 private:
  /// What one program is so far.
  struct State {
    PlannedProgram at;
    std::array<std::int64_t, 3> place{};
  };

  /// Where a program was, to go back to.
  struct Mark {
    std::size_t items = 0;
    std::int64_t frames = 0;
    std::int64_t cuts = 0;
    double time_s = 0.0;
    std::array<std::int64_t, 3> place{};
  };

  Mark mark() const;
  void go_back_to(const Mark& mark);
  void begin();
  void begin_next();
  void move(Axis axis, std::int64_t to);
  void single(Axis axis, std::int64_t to);
  bool ends_in_time() const;
  void require_in_time() const;
  double time_of(std::int64_t steps) const;

  const PlanedPart& part_;
  std::string set_;
  std::array<std::int64_t, 3> least_{};
  std::array<std::int64_t, 3> home_{};
  std::int64_t stroke_end_ = 0;
  std::vector<PlannedProgram> done_;
  State state_;
};

}  // namespace retrace::fabrication
