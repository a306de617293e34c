#pragma once

// Dialects of NC text as tables: the text that each dialect uses for each item of a program.

#include <span>
#include <string_view>

#include "fabrication/post/post.h"

namespace retrace::fabrication {

/// Texts of a dialect, which are complete lines. Texts with {} are formats of the fmt library. The comment of each
/// format lists its arguments after "Arguments:", from {0} on. "control" means three arguments: {0} the coordinate
/// system, {1} the letter of the increment system, and {2} additional codes that the control needs.
struct DialectFormats {
  Dialect dialect;
  bool subroutines_first = false;  ///< true: subroutines precede the main part of the file; false: they follow it
  std::string_view file_ends;      ///< first and last line of the file
  std::string_view main_begin;     ///< line before the main part
  std::string_view main_end;       ///< line after the main part
  std::string_view needs;          ///< requirements on the control, as text for the header. Arguments: control
  /// Preparation: plane, mm, absolute positions, feed per minute, compensations and blending off, exact stop, first
  /// zero offset, spindle off. Arguments: control.
  std::string_view prepare;
  std::string_view spindle_start;     ///< Arguments: speed in rpm; M3 or M4; start text of the program
  std::string_view spindle_stop;      ///< Arguments: stop text of the program
  std::string_view comment;           ///< Arguments: text
  std::string_view message;           ///< Arguments: text
  std::string_view subroutine_begin;  ///< Arguments: number; title
  std::string_view subroutine_end;    ///< Arguments: number
  std::string_view call;              ///< Arguments: number
  std::string_view rapid;             ///< word that begins a rapid move
  std::string_view linear;            ///< word that begins a linear move
  std::string_view dwell;             ///< Arguments: seconds; milliseconds
  std::string_view path_begin;        ///< start of a path of timed moves without stops. Arguments: tolerance; control
  /// Duration of a move in a path. Arguments: inverse time (1/min); milliseconds; speed of all axes together, in mm and
  /// degrees per minute.
  std::string_view path_time;
  std::string_view path_end;  ///< return to exact stops and feeds per minute. Arguments: control
  /// Start of a path whose moves contain positions, velocities and times, for controls that interpolate by cubic
  /// polynomials. It is empty if the control cannot do this.
  std::string_view cubic_begin = {};
  std::string_view cubic_end = {};
  std::string_view cubic_word = {};  ///< one axis of a move with velocities. Arguments: letter; position; velocity
  /// Move with velocities. Arguments: words of all axes; list of letters; list of positions; list of velocities;
  /// duration in milliseconds; duration in seconds; time since the start of the path in seconds.
  std::string_view cubic_move = {};
  double cubic_time_s = 1.0;  ///< time unit of the velocities, in s
  std::string_view mist_on = "M7\n";
  std::string_view mist_off = "M9\n";
  std::string_view optional_stop = "M1\n";
  std::string_view stop = "M0\n";
  /// Position of a modulo axis that moves along the shortest path. Arguments: letter; degrees, 0 to 360.
  std::string_view shortest = {};
  std::string_view increment = {};  ///< increment of a modulo axis in a path. Arguments: letter; degrees
  bool has_own_texts = false;       ///< true: the machine file defines the lines for mist and stops
  bool has_increment_systems = false;
  bool has_incremental_paths = false;  ///< true: all positions of a path are increments
  bool has_paths_by_speed = false;     ///< true: durations of moves in a path are given as speeds
};

/// Returns all dialects. The first one is the reference dialect.
std::span<const DialectFormats> dialect_formats();

}  // namespace retrace::fabrication
