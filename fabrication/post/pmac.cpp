#include "fabrication/post/dialect_writer.h"

namespace retrace::fabrication {
namespace {

/// Power PMAC script (Power PMAC user's and software reference manuals): no G codes, an explicit prelude, dwells in ms.
/// Coordinate system 1 is to have the axes X, Y, Z in mm and A, C in degrees. M codes are subprograms of the
/// integrator's, and one that is missing is skipped without a word: what starts and stops a spindle is told from
/// outside.
class Pmac : public DialectWriter {
 public:
  bool subroutines_first() const override { return true; }
  void begin_main(NcText& out) const override { out.line("open prog 1"); }
  void end_main(NcText& out) const override { out.line("close"); }
  void prepare(NcText& out) const override {
    out.line("Coord[1].FeedTime=60000");
    out.line("Coord[1].NoBlend=1");
    out.line("Coord[1].SegMoveTime=0");
    out.line("frax(X,Y,Z)");
    out.line("ccmode0");
    out.line("abs");
    out.line("M5");
  }
  /// \pre the spindle has its texts
  void start_spindle(NcText& out, const Spindle& spindle) const override { out.line(spindle.start_text); }
  void stop_spindle(NcText& out, const Spindle& spindle) const override { out.line(spindle.stop_text); }
  void comment(NcText& out, std::string_view text) const override { out.add("// ").line(text); }
  void message(NcText& out, std::string_view text) const override { comment(out, text); }
  void begin_subroutine(NcText& out, const Subroutine& subroutine) const override {
    comment(out, subroutine.title);
    out.add("open subprog ").number(subroutine.number).end_line();
    out.line("inc");
  }
  void end_subroutine(NcText& out, const Subroutine&) const override {
    out.line("abs");
    out.line("close");
  }
  void call(NcText& out, int number) const override { out.add("call ").number(number).end_line(); }
  void rapid(NcText& out, const Words& words) const override { out.add("rapid").words(words).end_line(); }
  void feed(NcText& out, const Words& words, double feed_mm_per_min) const override {
    out.add("linear").words(words).add(" F").decimal(feed_mm_per_min).end_line();
  }
  void dwell(NcText& out, int ms) const override { out.add("dwell ").number(ms).end_line(); }
  void begin_trace(NcText& out) const override {
    out.line("Coord[1].NoBlend=0");
    out.line("ta0 ts0");
  }
  void trace_point(NcText& out, const Words& words, double seconds) const override {
    out.add("linear").words(words).add(" tm").decimal(1e3 * seconds, 6).end_line();
  }
  void end_trace(NcText& out) const override { out.line("Coord[1].NoBlend=1"); }
};

}  // namespace

std::unique_ptr<DialectWriter> make_pmac() {
  return std::make_unique<Pmac>();
}

}  // namespace retrace::fabrication
