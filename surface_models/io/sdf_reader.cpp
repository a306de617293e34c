// Reads surface data files (SDF) in ASCII form: ISO 25178-71:2017 (aISO-1.0), and the older aBCR-1.0 with the same
// layout. A file consists of a line with the version, lines "key = value" up to a "*", and the heights up to another
// "*".

#include <fmt/format.h>

#include <map>

#include "surface_models/io/raw_map.h"

namespace retrace::surface_models {
namespace {

constexpr double kUmPerM = 1e6;
constexpr double kNmPerM = 1e9;

struct HeaderValue {
  std::string text;
  int line = 0;
};

class SdfReader {
 public:
  explicit SdfReader(const Source& source) : source_(source), lines_(source.content) {}

  RawMap read() {
    lines_.next();
    read_header();
    RawMap raw;
    raw.format = "SDF, ASCII (ISO 25178-71)";
    const double columns = number("numpoints");
    const double rows = number("numprofiles");
    check_size(source_, header_.at("numpoints").line, columns, rows);
    raw.columns = static_cast<std::size_t>(columns);
    raw.rows = static_cast<std::size_t>(rows);
    raw.x_pixel_um = scale("xscale") * kUmPerM;
    if (raw.rows > 1) raw.y_pixel_um = scale("yscale") * kUmPerM;
    raw.nm_per_unit = scale("zscale") * kNmPerM;
    refuse_unless_zero("compression");
    refuse_unless_zero("checktype");
    read_heights(raw);
    return raw;
  }

 private:
  void read_header() {
    while (const auto line = lines_.next()) {
      const std::string_view text = trimmed(*line);
      if (text.empty()) continue;
      if (text.starts_with('*')) return;
      const std::size_t equals = text.find('=');
      if (equals == std::string_view::npos)
        source_.fail(lines_.number(), "must be \"key = value\" or \"*\", got " + in_quotes(text));
      header_[lower_case(trimmed(text.substr(0, equals)))] = {std::string(trimmed(text.substr(equals + 1))),
                                                              lines_.number()};
    }
    source_.fail(lines_.number(), "the file ends within its header; the header must end with a line \"*\"");
  }

  double number(const std::string& key) const {
    const auto found = header_.find(key);
    if (found == header_.end()) source_.fail(0, fmt::format("{}: is missing in the header of the file", key));
    const std::optional<double> value = number_in(found->second.text);
    if (!value)
      source_.fail(found->second.line, fmt::format("{}: must be a number, got {}", key, in_quotes(found->second.text)));
    return *value;
  }

  double scale(const std::string& key) const {
    const double value = number(key);
    if (!(value > 0.0)) source_.fail(header_.at(key).line, fmt::format("{}: must be > 0, got {}", key, value));
    return value;
  }

  void refuse_unless_zero(const std::string& key) const {
    if (header_.contains(key) && number(key) != 0.0)
      source_.fail(header_.at(key).line,
                   fmt::format("{}: must be 0 (none), got {}", key, in_quotes(header_.at(key).text)));
  }

  void read_heights(RawMap& raw) {
    const std::size_t wanted = raw.columns * raw.rows;
    while (const auto line = lines_.next()) {
      std::string_view text = trimmed(*line);
      if (text.starts_with('*')) break;
      while (!text.empty()) {
        const std::string_view word = text.substr(0, text.find_first_of(" \t"));
        text = trimmed(text.substr(word.size()));
        if (raw.heights.size() == wanted)
          source_.fail(lines_.number(),
                       fmt::format("the file contains more heights than the {} that its header specifies", wanted));
        raw.heights.push_back(height(word));
      }
    }
    if (raw.heights.size() != wanted)
      source_.fail(lines_.number(), fmt::format("the file ends after {} of {} heights", raw.heights.size(), wanted));
  }

  double height(std::string_view word) const {
    if (word == "BAD") return kMissing;
    const std::optional<double> value = number_in(word);
    if (!value) source_.fail(lines_.number(), "a height must be a number or BAD, got " + in_quotes(word));
    return *value;
  }

  const Source& source_;
  Lines lines_;
  std::map<std::string, HeaderValue> header_;
};

}  // namespace

RawMap parse_sdf(const Source& source) {
  return SdfReader(source).read();
}

}  // namespace retrace::surface_models
