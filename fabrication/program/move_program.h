#pragma once

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

/// A program without subroutines: preparation, moves and lines for people in their order, end.
struct MoveProgram {
  std::string name;  ///< of the file, without its ending
  std::vector<std::string> header;
  std::vector<std::variant<LinearMove, Comment, Message>> items;
};

}  // namespace retrace::fabrication
