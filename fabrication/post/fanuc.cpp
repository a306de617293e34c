#include "fabrication/post/dialect_writer.h"

namespace retrace::fabrication {
namespace {

/// Fanuc 30i (operator's manual B-63944). Six decimals ask for increment system IS-E or a setting as fine. Messages are
/// comments: #3006 would stop the machine.
class Fanuc : public DialectWriter {
 public:
  bool subroutines_first() const override { return false; }
  void begin_file(NcText& out) const override { out.line("%"); }
  void end_file(NcText& out) const override { out.line("%"); }
  void begin_main(NcText& out) const override { out.line("O0001"); }
  void end_main(NcText& out) const override { out.line("M30"); }
  void prepare(NcText& out) const override {
    out.line("G17 G21 G40 G49 G80 G90 G94");
    out.line("G54 G61 G69");
    out.line("M5");
  }
  void start_spindle(NcText& out, const Spindle& spindle) const override {
    out.add("G97 ");  // S is no cutting speed
    DialectWriter::start_spindle(out, spindle);
  }
  void comment(NcText& out, std::string_view text) const override { out.add("(").add(text).line(")"); }
  void message(NcText& out, std::string_view text) const override { comment(out, text); }
  void begin_subroutine(NcText& out, const Subroutine& subroutine) const override {
    out.add(number_of('O', subroutine.number)).end_line();
    comment(out, subroutine.title);
    out.line("G91");
  }
  void end_subroutine(NcText& out, const Subroutine&) const override {
    out.line("G90");
    out.line("M99");
  }
  void call(NcText& out, int number) const override { out.add("M98 ").add(number_of('P', number)).end_line(); }
  void dwell(NcText& out, int ms) const override { out.add("G4 P").number(ms).end_line(); }

 private:
  /// Four digits, as program numbers have.
  static std::string number_of(char letter, int number) {
    std::string digits = std::to_string(number);
    if (digits.size() < 4) digits.insert(0, 4 - digits.size(), '0');
    return letter + digits;
  }
};

}  // namespace

std::unique_ptr<DialectWriter> make_fanuc() {
  return std::make_unique<Fanuc>();
}

}  // namespace retrace::fabrication
