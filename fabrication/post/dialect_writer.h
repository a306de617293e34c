#pragma once

// What a dialect must be able to say. A new one is one file with a class of this kind and its make_ function, and a
// line in post.cpp.

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "fabrication/program/move_program.h"
#include "fabrication/program/program.h"

namespace retrace::fabrication {

/// Words of one move; those that are not there stay as they are.
struct Words {
  std::optional<Nanometres> x_nm;
  std::optional<Nanometres> y_nm;
  std::optional<Nanometres> z_nm;
  std::optional<RotaryUnits> a;  ///< of the axis that tilts
  std::optional<RotaryUnits> c;
  char tilt_letter = 'A';
};

/// Collects the lines of a file. Numbers are written from integers, digit by digit.
class NcText {
 public:
  NcText& add(std::string_view text);
  NcText& number(long long value);
  /// " X1.000000 Y..." with six decimals of a mm, seven of a degree.
  NcText& words(const Words& words);
  /// Three decimals and a point.
  NcText& decimal(double value);
  NcText& decimal(double value, int decimals);
  NcText& end_line();
  void line(std::string_view text) { add(text).end_line(); }
  std::string take() { return std::move(text_); }

 private:
  void fixed_point(char letter, long long value, int decimals);
  std::string text_;
};

/// What is not said otherwise is ISO code.
class DialectWriter {
 public:
  virtual ~DialectWriter() = default;

  /// Whether subroutines stand before the main part, or after it.
  virtual bool subroutines_first() const = 0;
  virtual void begin_file(NcText&) const {}
  virtual void end_file(NcText&) const {}
  /// The main part: what precedes its first line and follows its last one.
  virtual void begin_main(NcText&) const {}
  virtual void end_main(NcText& out) const = 0;
  /// Plane, mm, absolute, feed per minute, compensations and blending off, exact stop, first zero offset, spindle off.
  virtual void prepare(NcText& out) const = 0;
  virtual void mist(NcText& out, bool on) const { out.line(on ? "M7" : "M9"); }
  /// S in turns per minute with M3 or M4, and M5, unless the dialect says otherwise.
  virtual void start_spindle(NcText& out, const Spindle& spindle) const;
  virtual void stop_spindle(NcText& out, const Spindle& spindle) const;
  virtual void comment(NcText& out, std::string_view text) const = 0;
  virtual void message(NcText& out, std::string_view text) const = 0;
  virtual void optional_stop(NcText& out) const { out.line("M1"); }
  virtual void begin_subroutine(NcText& out, const Subroutine& subroutine) const = 0;
  virtual void end_subroutine(NcText& out, const Subroutine& subroutine) const = 0;
  virtual void call(NcText& out, int number) const = 0;
  virtual void rapid(NcText& out, const Words& words) const { out.add("G0").words(words).end_line(); }
  virtual void feed(NcText& out, const Words& words, double feed_mm_per_min) const {
    out.add("G1").words(words).add(" F").decimal(feed_mm_per_min).end_line();
  }
  virtual void dwell(NcText& out, int ms) const = 0;
  /// A path without stops, its moves timed; afterwards exact stop and feeds per minute again.
  virtual void begin_trace(NcText& out) const {
    out.line("G64");
    out.line("G93");
  }
  /// Inverse time: F is the number of such moves in a minute.
  virtual void trace_point(NcText& out, const Words& words, double seconds) const {
    out.add("G1").words(words).add(" F").decimal(60.0 / seconds, 6).end_line();
  }
  virtual void end_trace(NcText& out) const {
    out.line("G94");
    out.line("G61");
  }
};

std::unique_ptr<DialectWriter> make_rs274ngc();
std::unique_ptr<DialectWriter> make_sinumerik();
std::unique_ptr<DialectWriter> make_fanuc();
std::unique_ptr<DialectWriter> make_pmac();

}  // namespace retrace::fabrication
