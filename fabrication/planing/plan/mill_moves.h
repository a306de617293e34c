#pragma once

// Writes the moves of a planing mill that can move only one axis at a time and only by at least a minimum distance. The
// moves are divided into programs of limited duration.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "fabrication/planing/part.h"
#include "fabrication/planing/plan/plan.h"

namespace retrace::fabrication {

/// Writes the moves of a planing mill. Each move is of one axis, on the grid, and at least as long as the minimum move.
/// A shorter distance is covered by two longer moves in opposite directions. A new program starts if the present one
/// would take longer than the machine allows.
class MillMoves {
 public:
  /// \pre `part` has a mill and outlives this object
  MillMoves(const PlanedPart& part, std::string set);

  /// Lowers the tool to a depth, outside of the part.
  /// \param depth depth below the face, in steps of the grid
  void lower_to(std::int64_t depth);
  void across_to(std::int64_t x);
  /// Moves along the zones and back.
  void stroke();
  /// Moves up, and then back to the centre of the lens.
  void return_to_centre();
  /// Makes moves that must be in one program. If the present program would exceed its time limit with them, they become
  /// the first moves of the next program.
  /// \throw InputError if these moves exceed the time limit even in a program without other moves
  template <class Moves>
  void in_one_program(const Moves& moves) {
    const Snapshot before = snapshot();
    moves();
    if (ends_in_time()) return;
    restore(before);
    begin_next();
    moves();
    require_in_time();
  }
  std::vector<PlannedProgram> finish();

 private:
  /// Present program, and position of the tool.
  struct State {
    PlannedProgram at;
    std::array<std::int64_t, 3> position{};
  };

  /// State of a program, to which restore() can return.
  struct Snapshot {
    std::size_t items = 0;
    std::int64_t frames = 0;
    std::int64_t cuts = 0;
    double time_s = 0.0;
    std::array<std::int64_t, 3> position{};
  };

  Snapshot snapshot() const;
  void restore(const Snapshot& mark);
  void begin();
  void begin_next();
  void move(Axis axis, std::int64_t to);
  void single(Axis axis, std::int64_t to);
  bool ends_in_time() const;
  void require_in_time() const;
  double time_of(std::int64_t steps) const;

  const PlanedPart& part_;
  std::string set_;
  std::array<std::int64_t, 3> min_steps_{};
  std::array<std::int64_t, 3> home_{};
  std::int64_t stroke_end_ = 0;
  std::vector<PlannedProgram> done_;
  State state_;
};

}  // namespace retrace::fabrication
