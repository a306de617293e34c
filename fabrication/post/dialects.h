#pragma once

// The dialects of NC text as data: how each of them says what a program asks for.

#include <span>
#include <string_view>

#include "fabrication/post/post.h"

namespace retrace::fabrication {

/// The words of a dialect. Texts are whole lines, with their ends; those with {} are formats (fmt) of what is named
/// behind them, counted from {0}; "control" stands for {0} its coordinate system, {1} the letter of its increment
/// system, {2} the codes that it needs beyond those of all.
struct DialectWords {
  Dialect dialect;
  bool subroutines_first = false;     ///< before the main part, or after it
  std::string_view file_ends;         ///< first and last line of the file
  std::string_view main_begin;        ///< what precedes the first line of the main part
  std::string_view main_end;          ///< what follows its last one
  std::string_view needs;             ///< what must hold that no program can say: lines for people; control
  std::string_view prepare;           ///< plane, mm, absolute words, feed per minute, compensations and blending off,
                                      ///< exact stop, first zero offset, spindle off; control
  std::string_view spindle_start;     ///< turns per minute; M3 or M4; the program's own text
  std::string_view spindle_stop;      ///< the program's own text
  std::string_view comment;           ///< text
  std::string_view message;           ///< text
  std::string_view subroutine_begin;  ///< number; title
  std::string_view subroutine_end;    ///< number
  std::string_view call;              ///< number
  std::string_view rapid;             ///< word before those of the axes
  std::string_view linear;
  std::string_view dwell;       ///< seconds; milliseconds
  std::string_view path_begin;  ///< a path without stops, its moves timed; mm that it may be left by; control
  std::string_view path_time;   ///< moves like this in a minute; milliseconds; speed of all axes together, in mm and
                                ///< degrees per minute
  std::string_view path_end;    ///< exact stop and feeds per minute again; control
  /// A path whose moves say places, velocities and times, for a control that joins them by cubics; empty: it cannot.
  std::string_view cubic_begin = {};
  std::string_view cubic_end = {};
  std::string_view cubic_word = {};  ///< of an axis: letter; place; velocity
  /// A move: words of all axes; their letters, places and velocities, each as a list; its milliseconds; its seconds;
  /// seconds since the path began
  std::string_view cubic_move = {};
  double cubic_time_s = 1.0;  ///< that velocities are per
  std::string_view mist_on = "M7\n";
  std::string_view mist_off = "M9\n";
  std::string_view optional_stop = "M1\n";
  std::string_view stop = "M0\n";
  std::string_view shortest = {};   ///< of a modulo axis: letter; degrees within a turn
  std::string_view increment = {};  ///< of a modulo axis within a path: letter; degrees
  bool has_own_texts = false;       ///< mist and stops are lines of the machine's file
  bool has_increment_systems = false;
  bool has_incremental_paths = false;  ///< all words of a path are increments
  bool has_paths_by_speed = false;     ///< times of a path follow from speeds alone
};

/// All dialects, the reference first.
std::span<const DialectWords> dialect_words();

}  // namespace retrace::fabrication
