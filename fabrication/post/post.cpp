#include "fabrication/post/post.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "core/message_text.h"
#include "fabrication/post/dialect_writer.h"

namespace retrace::fabrication {
namespace {

struct Entry {
  Dialect dialect;
  std::unique_ptr<DialectWriter> (*make)();
};

const std::array<Entry, 4> kEntries = {
    Entry{{"rs274ngc", ".ngc", "RS274/NGC as LinuxCNC reads it: the reference"}, make_rs274ngc},
    Entry{{"sinumerik", ".mpf", "Siemens Sinumerik 840D"}, make_sinumerik},
    Entry{{"fanuc", ".nc", "Fanuc, 30i series"}, make_fanuc},
    Entry{{"pmac", ".pmc", "Omron (Delta Tau) Power PMAC"}, make_pmac}};

class FileWriter {
 public:
  FileWriter(const DialectWriter& dialect, const Program& program) : dialect_(dialect), program_(program) {}

  std::string run() {
    dialect_.begin_file(out_);
    if (dialect_.subroutines_first()) {
      header();
      subroutines();
      dialect_.begin_main(out_);
    } else {
      dialect_.begin_main(out_);
      header();
    }
    dialect_.prepare(out_);
    for (const Item& item : program_.items) std::visit(*this, item);
    if (mist_on_) dialect_.mist(out_, false);
    dialect_.end_main(out_);
    if (!dialect_.subroutines_first()) subroutines();
    dialect_.end_file(out_);
    return out_.take();
  }

  void operator()(const Comment& comment) { dialect_.comment(out_, comment.text); }
  void operator()(const Message& message) { dialect_.message(out_, message.text); }
  void operator()(const OptionalStop&) {
    // The chips stay where they fell while somebody looks.
    if (mist_on_) dialect_.mist(out_, false);
    dialect_.optional_stop(out_);
    if (mist_on_) dialect_.mist(out_, true);
  }
  void operator()(const Raise& raise) {
    if (mist_on_) dialect_.mist(out_, false);
    mist_on_ = false;
    at_.z_nm = raise.z_nm;
    Words words;
    words.z_nm = raise.z_nm;
    dialect_.rapid(out_, words);
  }
  void operator()(const Turn& turn) {
    Words words;
    words.a = turn.a;
    words.c = turn.c;
    words.tilt_letter = program_.tilt_letter;
    dialect_.rapid(out_, words);
  }
  void operator()(const Trace& trace) {
    const TracePoint& first = trace.points.front();
    Words start;
    start.x_nm = first.x_nm;
    start.y_nm = first.y_nm;
    start.c = first.c;
    dialect_.rapid(out_, start);
    if (!mist_on_) dialect_.mist(out_, true);
    mist_on_ = true;
    Words down;
    down.z_nm = first.z_nm;
    dialect_.feed(out_, down, trace.approach_feed_mm_per_min);
    dialect_.begin_trace(out_);
    const TracePoint* last = &first;
    for (const TracePoint& p : std::span(trace.points).subspan(1)) {
      Words words;
      words.x_nm = p.x_nm;
      if (p.y_nm != last->y_nm) words.y_nm = p.y_nm;
      words.z_nm = p.z_nm;
      if (p.c != last->c) words.c = p.c;
      dialect_.trace_point(out_, words, p.seconds);
      last = &p;
    }
    dialect_.end_trace(out_);
    at_ = {last->x_nm, last->y_nm, last->z_nm, at_.a, last->c};
  }
  void operator()(const Visit& visit) {
    dialect_.comment(out_, fmt::format("element {}", visit.element));
    for (const Rapid& rapid : approach(at_, visit)) {
      Words words;
      words.x_nm = rapid.x_nm;
      words.y_nm = rapid.y_nm;
      words.z_nm = rapid.z_nm;
      dialect_.rapid(out_, words);
    }
    if (!mist_on_) dialect_.mist(out_, true);
    mist_on_ = true;
    const Subroutine& subroutine = program_.subroutines[visit.subroutine];
    dialect_.call(out_, subroutine.number);
    const Reach& reach = reaches_[visit.subroutine];
    at_.x_nm = visit.x_nm + reach.x_end_nm;
    at_.y_nm = visit.y_nm + reach.y_end_nm;
    at_.z_nm = visit.z_nm + reach.z_end_nm;
  }

 private:
  void header() {
    for (const std::string& line : program_.header) dialect_.comment(out_, line);
  }

  void subroutines() {
    for (const Subroutine& subroutine : program_.subroutines) {
      dialect_.begin_subroutine(out_, subroutine);
      for (const Step& step : subroutine.steps) {
        if (const auto* dwell = std::get_if<Dwell>(&step)) {
          dialect_.dwell(out_, dwell->ms);
          continue;
        }
        const auto& move = std::get<Increment>(step);
        Words words;
        if (move.x_nm != 0) words.x_nm = move.x_nm;
        if (move.y_nm != 0) words.y_nm = move.y_nm;
        if (move.z_nm != 0) words.z_nm = move.z_nm;
        dialect_.feed(out_, words, move.feed_mm_per_min);
      }
      dialect_.end_subroutine(out_, subroutine);
    }
  }

  static std::vector<Reach> reaches(const Program& program) {
    std::vector<Reach> result;
    for (const Subroutine& subroutine : program.subroutines) result.push_back(reach_of(subroutine));
    return result;
  }

  const DialectWriter& dialect_;
  const Program& program_;
  std::vector<Reach> reaches_ = reaches(program_);
  NcText out_;
  Position at_;
  bool mist_on_ = false;
};

}  // namespace

NcText& NcText::add(std::string_view text) {
  text_ += text;
  return *this;
}

NcText& NcText::number(long long value) {
  fmt::format_to(std::back_inserter(text_), "{}", value);
  return *this;
}

NcText& NcText::end_line() {
  text_ += '\n';
  return *this;
}

NcText& NcText::decimal(double value, int decimals) {
  fmt::format_to(std::back_inserter(text_), "{:.{}f}", value, decimals);
  return *this;
}

NcText& NcText::decimal(double value) {
  const long long thousandths = std::llround(value * 1e3);
  fmt::format_to(std::back_inserter(text_), "{}.{:03}", thousandths / 1000, thousandths % 1000);
  return *this;
}

void NcText::fixed_point(char letter, long long value, int decimals) {
  long long one = 1;
  for (int k = 0; k < decimals; ++k) one *= 10;
  const unsigned long long size =
      value < 0 ? 0ULL - static_cast<unsigned long long>(value) : static_cast<unsigned long long>(value);
  const auto unit = static_cast<unsigned long long>(one);
  fmt::format_to(std::back_inserter(text_), " {}{}{}.{:0{}}", letter, value < 0 ? "-" : "", size / unit, size % unit,
                 decimals);
}

NcText& NcText::words(const Words& words) {
  constexpr int kLinearDecimals = 6;
  constexpr int kRotaryDecimals = 7;
  if (words.x_nm) fixed_point('X', *words.x_nm, kLinearDecimals);
  if (words.y_nm) fixed_point('Y', *words.y_nm, kLinearDecimals);
  if (words.z_nm) fixed_point('Z', *words.z_nm, kLinearDecimals);
  if (words.a) fixed_point(words.tilt_letter, *words.a, kRotaryDecimals);
  if (words.c) fixed_point('C', *words.c, kRotaryDecimals);
  return *this;
}

void DialectWriter::start_spindle(NcText& out, const Spindle& spindle) const {
  out.add("S").number(spindle.rpm).line(spindle.is_clockwise ? " M3" : " M4");
}

void DialectWriter::stop_spindle(NcText& out, const Spindle&) const {
  out.line("M5");
}

std::span<const Dialect> dialects() {
  static const std::array<Dialect, kEntries.size()> all = [] {
    std::array<Dialect, kEntries.size()> result;
    for (std::size_t k = 0; k < kEntries.size(); ++k) result[k] = kEntries[k].dialect;
    return result;
  }();
  return all;
}

namespace {

const Entry& entry_of(std::string_view dialect) {
  std::vector<std::string_view> names;
  for (const Entry& entry : kEntries) {
    if (entry.dialect.name == dialect) return entry;
    names.push_back(entry.dialect.name);
  }
  throw InputError({"", 0, "--dialect"}, fmt::format("must be {}, got {}", alternatives(names), in_quotes(dialect)));
}

/// Writes the items of a program of moves.
struct MoveWriter {
  const DialectWriter& dialect;
  NcText& out;

  void operator()(const Comment& comment) const { dialect.comment(out, comment.text); }
  void operator()(const Message& message) const { dialect.message(out, message.text); }
  void operator()(const LinearMove& move) const {
    Words words;
    words.x_nm = move.x_nm;
    words.y_nm = move.y_nm;
    words.z_nm = move.z_nm;
    if (move.feed_mm_per_min > 0.0)
      dialect.feed(out, words, move.feed_mm_per_min);
    else
      dialect.rapid(out, words);
  }
};

}  // namespace

std::string nc_text(const Program& program, std::string_view dialect) {
  return FileWriter(*entry_of(dialect).make(), program).run();
}

std::string nc_text(const MoveProgram& program, std::string_view dialect) {
  const std::unique_ptr<DialectWriter> writer = entry_of(dialect).make();
  NcText out;
  writer->begin_file(out);
  writer->begin_main(out);
  for (const std::string& line : program.header) writer->comment(out, line);
  writer->prepare(out);
  if (program.spindle) writer->start_spindle(out, *program.spindle);
  for (const auto& item : program.items) std::visit(MoveWriter{*writer, out}, item);
  if (program.spindle) writer->stop_spindle(out, *program.spindle);
  writer->end_main(out);
  writer->end_file(out);
  return out.take();
}

std::string_view ending_of(std::string_view dialect) {
  return entry_of(dialect).dialect.ending;
}

}  // namespace retrace::fabrication
