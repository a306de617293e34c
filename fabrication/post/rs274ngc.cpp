#include "fabrication/post/dialect_writer.h"

namespace retrace::fabrication {
namespace {

/// RS274/NGC as LinuxCNC's interpreter reads it (T. Kramer et al., NISTIR 6556, 2000; LinuxCNC's o-word subroutines).
class Rs274ngc : public DialectWriter {
 public:
  bool subroutines_first() const override { return true; }
  void begin_file(NcText& out) const override { out.line("%"); }
  void end_file(NcText& out) const override { out.line("%"); }
  void end_main(NcText& out) const override { out.line("M2"); }
  void prepare(NcText& out) const override {
    out.line("G17 G21 G40 G49 G80 G90 G94");
    out.line("G54 G61 G92.1");
    out.line("M5");
  }
  void start_spindle(NcText& out, const Spindle& spindle) const override {
    out.add("G97 ");  // S is no cutting speed
    DialectWriter::start_spindle(out, spindle);
  }
  void comment(NcText& out, std::string_view text) const override { out.add("(").add(text).line(")"); }
  void message(NcText& out, std::string_view text) const override { out.add("(MSG, ").add(text).line(")"); }
  void begin_subroutine(NcText& out, const Subroutine& subroutine) const override {
    comment(out, subroutine.title);
    out.add("o").number(subroutine.number).line(" sub");
    out.line("G91");
  }
  void end_subroutine(NcText& out, const Subroutine& subroutine) const override {
    out.line("G90");
    out.add("o").number(subroutine.number).line(" endsub");
  }
  void call(NcText& out, int number) const override { out.add("o").number(number).line(" call"); }
  void dwell(NcText& out, int ms) const override { out.add("G4 P").decimal(1e-3 * ms).end_line(); }
};

}  // namespace

std::unique_ptr<DialectWriter> make_rs274ngc() {
  return std::make_unique<Rs274ngc>();
}

}  // namespace retrace::fabrication
