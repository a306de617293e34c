#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "fabrication/program/program.h"

namespace retrace::fabrication {

/// One straight move of linear axes to absolute positions: rapid, or at a feed.
struct LinearMove {
  std::optional<Nanometres> x_nm;
  std::optional<Nanometres> y_nm;
  std::optional<Nanometres> z_nm;
  double feed_mm_per_min = 0.0;  ///< 0: rapid
};

/// How the spindle turns while a program cuts.
struct Spindle {
  std::int32_t rpm = 0;
  bool is_clockwise = true;  ///< M3 of ISO 6983-1, otherwise M4
  std::string start_text;    ///< lines for a dialect that has no words of its own for it; empty: none
  std::string stop_text;
};

/// A program without subroutines: preparation, moves and lines for people in their order, end.
struct MoveProgram {
  std::string name;  ///< of the file, without its ending
  std::vector<std::string> header;
  std::optional<Spindle> spindle;  ///< turns from before the first item to behind the last; nothing: stands still
  std::vector<std::variant<LinearMove, Comment, Message>> items;
};

}  // namespace retrace::fabrication
