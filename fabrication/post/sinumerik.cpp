#include "fabrication/post/dialect_writer.h"

namespace retrace::fabrication {
namespace {

/// Siemens Sinumerik 840D (programming manuals Fundamentals and Job Planning). Routines are sections of the main
/// program behind its end, called by CALL BLOCK, so that one file runs alone.
class Sinumerik : public DialectWriter {
 public:
  bool subroutines_first() const override { return false; }
  void end_main(NcText& out) const override { out.line("M30"); }
  void prepare(NcText& out) const override {
    out.line("TRAFOOF");
    out.line("TRANS");
    out.line("G17 G710 G40 G90 G94");
    out.line("G54 G60 D0");
    out.line("M5");
  }
  void comment(NcText& out, std::string_view text) const override { out.add("; ").line(text); }
  void message(NcText& out, std::string_view text) const override { out.add("MSG(\"").add(text).line("\")"); }
  void begin_subroutine(NcText& out, const Subroutine& subroutine) const override {
    comment(out, subroutine.title);
    out.add("RT").number(subroutine.number).line(":");
    out.line("G91");
  }
  void end_subroutine(NcText& out, const Subroutine& subroutine) const override {
    out.line("G90");
    out.add("RE").number(subroutine.number).line(":");
  }
  void call(NcText& out, int number) const override {
    out.add("CALL BLOCK RT").number(number).add(" TO RE").number(number).end_line();
  }
  void dwell(NcText& out, int ms) const override { out.add("G4 F").decimal(1e-3 * ms).end_line(); }
  void end_trace(NcText& out) const override {
    out.line("G94");
    out.line("G60");
  }
};

}  // namespace

std::unique_ptr<DialectWriter> make_sinumerik() {
  return std::make_unique<Sinumerik>();
}

}  // namespace retrace::fabrication
