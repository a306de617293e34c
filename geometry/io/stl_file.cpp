#include "geometry/io/stl_file.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>
#include <system_error>
#include <unordered_map>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/leading_number.h"
#include "core/message_text.h"
#include "core/text.h"

// STL is read without a library, because no suitable library reports the line of an error. A binary file is a header
// and an array. An ASCII file has a grammar of seven keywords.

namespace retrace::geometry {
namespace {

constexpr std::size_t kHeaderBytes = 80;
constexpr std::size_t kCountBytes = 4;
constexpr std::size_t kTriangleBytes = 50;
constexpr double kLargestCoordinateMm = 1e6;

static_assert(std::endian::native == std::endian::little, "binary STL is little-endian");

template <class Value>
void append(std::string& text, const Value& value) {
  std::array<char, sizeof(Value)> bytes{};
  std::memcpy(bytes.data(), &value, sizeof(Value));
  text.append(bytes.data(), bytes.size());
}

void append(std::string& text, const Vec3& v) {
  for (const double c : {v.x(), v.y(), v.z()}) append(text, static_cast<float>(c));
}

template <class Value>
Value value_at(std::string_view text, std::size_t at) {
  Value value{};
  std::memcpy(&value, text.data() + at, sizeof(Value));
  return value;
}

[[noreturn]] void refuse_count(const std::string& name) {
  throw InputError({name, 0, ""}, fmt::format("must have at most {} triangles", kMaxStlTriangles));
}

class Welder {
 public:
  Welder(const std::string& name, double scale) : name_(name), scale_(scale) {}

  /// \param where location for messages, such as "triangle 7" or "line 12"
  void add(const std::array<Vec3, 3>& corners, const InputLocation& where, std::string_view what) {
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k) triangle[k] = vertex(corners[k], where, what);
    if (++read_ > kMaxStlTriangles) refuse_count(name_);
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) return;
    mesh_.triangles.push_back(triangle);
  }

  TriangleMesh finish() {
    if (mesh_.triangles.empty()) throw InputError({name_, 0, ""}, "the mesh must have at least one triangle, got none");
    return std::move(mesh_);
  }

 private:
  struct Hash {
    std::size_t operator()(const std::array<double, 3>& p) const {
      std::size_t hash = 0;
      for (const double c : p) hash = hash * 0x9e3779b97f4a7c15U + std::hash<double>{}(c);
      return hash;
    }
  };

  std::uint32_t vertex(const Vec3& p, const InputLocation& where, std::string_view what) {
    // Adding 0 converts -0 to +0.
    const std::array<double, 3> at = {scale_ * p.x() + 0.0, scale_ * p.y() + 0.0, scale_ * p.z() + 0.0};
    for (const double c : at)
      if (!(std::abs(c) < kLargestCoordinateMm))
        throw InputError(where, fmt::format("{}coordinates must be finite and below 1e6 mm, got {}", what, c));
    const auto [it, is_new] = known_.try_emplace(at, static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (is_new) mesh_.vertices.emplace_back(at[0], at[1], at[2]);
    return it->second;
  }

  const std::string& name_;
  double scale_;
  TriangleMesh mesh_;
  std::size_t read_ = 0;
  std::unordered_map<std::array<double, 3>, std::uint32_t, Hash> known_;
};

/// Returns the number of triangles that is stored after the header of a binary file.
/// \pre the text contains a header and this number
std::size_t binary_count(std::string_view text) {
  return value_at<std::uint32_t>(text, kHeaderBytes);
}

std::size_t binary_length(std::size_t triangles) {
  return kHeaderBytes + kCountBytes + kTriangleBytes * triangles;
}

/// Returns true if the length of the file matches the number of triangles in a binary header.
/// \param begin beginning of the file; it contains at least binary_length(0) bytes unless the file is shorter
bool is_binary(std::string_view begin, std::uintmax_t file_bytes) {
  return begin.size() >= binary_length(0) && file_bytes == binary_length(binary_count(begin));
}

/// Returns the number of bytes after the last triangle of a binary file. Returns 0 if there are none, or if the file
/// has no triangles or is too short for them.
std::size_t bytes_after_triangles(std::string_view begin, std::uintmax_t file_bytes) {
  if (begin.size() < binary_length(0) || binary_count(begin) == 0) return 0;
  const std::size_t wanted = binary_length(binary_count(begin));
  return file_bytes > wanted ? static_cast<std::size_t>(file_bytes - wanted) : 0;
}

/// Returns true if the header or the number of triangles contains a zero byte. Binary files contain zero bytes, but
/// text files do not.
bool begins_as_binary(std::string_view text) {
  return text.substr(0, binary_length(0)).find('\0') != std::string_view::npos;
}

/// Refuses a binary file whose length does not match its number of triangles.
/// \throw InputError always
[[noreturn]] void refuse_length(std::string_view begin, std::uintmax_t file_bytes, const std::string& name) {
  constexpr std::string_view what =
      "not an STL file: a binary STL file must have 84 bytes plus 50 bytes for each triangle";
  if (file_bytes < binary_length(0))
    throw InputError({name, 0, ""}, fmt::format("{}, but the file has {} bytes", what, file_bytes));
  const std::size_t wanted = binary_length(binary_count(begin));
  const std::string remedy = file_bytes > wanted
                                 ? fmt::format("remove the {} bytes after the last triangle", file_bytes - wanted)
                                 : "the file is truncated or has another format";
  throw InputError({name, 0, ""},
                   fmt::format("{}, which is {} bytes for its {} triangles, but the file has {} bytes: {}", what,
                               wanted, binary_count(begin), file_bytes, remedy));
}

TriangleMesh parse_binary(std::string_view text, const std::string& name, double scale) {
  Welder welder(name, scale);
  const std::size_t count = binary_count(text);
  for (std::size_t k = 0; k < count; ++k) {
    std::array<Vec3, 3> corners;
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t axis = 0; axis < 3; ++axis)
        corners[c][static_cast<Eigen::Index>(axis)] = static_cast<double>(
            value_at<float>(text, kHeaderBytes + kCountBytes + kTriangleBytes * k + 12 * (c + 1) + 4 * axis));
    welder.add(corners, {name, 0, ""}, fmt::format("triangle {}: ", k + 1));
  }
  return welder.finish();
}

/// Splits an ASCII file into words and counts its lines.
class Words {
 public:
  Words(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  int line() const { return line_; }

  /// Returns the next word, or an empty text at the end of the file.
  std::string_view next() {
    while (at_ < text_.size() && is_blank(text_[at_])) line_ += text_[at_++] == '\n' ? 1 : 0;
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_blank(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }

  void skip_line() {
    while (at_ < text_.size() && text_[at_] != '\n') ++at_;
  }

  /// Returns true if `got` is the keyword `word`, in upper or lower case.
  static bool is(std::string_view got, std::string_view word) {
    return got.size() == word.size() && lower_case(got) == word;
  }

  void expect(std::string_view word) {
    const std::string_view got = next();
    if (!is(got, word)) fail(word, got);
  }

  Vec3 vector() {
    Vec3 v;
    for (Eigen::Index axis = 0; axis < 3; ++axis) v[axis] = number();
    return v;
  }

  [[noreturn]] void fail(std::string_view wanted, std::string_view got) const {
    throw InputError({name_, line_, ""},
                     fmt::format("not an STL file: expected {}, got {}", wanted,
                                 got.empty() ? std::string("the end of the file") : in_quotes(got)));
  }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

  double number() {
    const std::string_view word = next();
    const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
    const std::optional<LeadingNumber> number = leading_number(digits);
    if (!number || number->length != digits.size()) fail("a number", word);
    return number->value;
  }

  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
  int line_ = 1;
};

TriangleMesh parse_ascii(std::string_view text, const std::string& name, double scale) {
  Words words(text, name);
  if (!Words::is(words.next(), "solid"))
    throw InputError({name, 0, ""}, "not an STL file: an STL file must begin with \"solid\" or be a binary STL file");
  words.skip_line();  // the rest of the line is the name of the solid
  Welder welder(name, scale);
  for (std::string_view word = words.next();; word = words.next()) {
    if (Words::is(word, "endsolid")) {
      words.skip_line();
      word = words.next();
      if (word.empty()) break;
      if (!Words::is(word, "solid")) words.fail("\"solid\" or the end of the file", word);
      words.skip_line();
      continue;
    }
    if (!Words::is(word, "facet")) words.fail("\"facet\" or \"endsolid\"", word);
    words.expect("normal");
    // the normal is skipped, because it follows from the vertices; some files contain nan
    for (int axis = 0; axis < 3; ++axis) words.next();
    words.expect("outer");
    words.expect("loop");
    std::array<Vec3, 3> corners;
    for (Vec3& corner : corners) {
      words.expect("vertex");
      corner = words.vector();
    }
    welder.add(corners, {name, words.line(), ""}, "");
    words.expect("endloop");
    words.expect("endfacet");
  }
  return welder.finish();
}

}  // namespace

std::string stl_text(const BoundaryMesh& mesh, std::string_view title) {
  std::string text(title.substr(0, kHeaderBytes));
  text.resize(kHeaderBytes, ' ');
  text.reserve(kHeaderBytes + kCountBytes + kTriangleBytes * mesh.triangles.size());
  append(text, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[t[0]];
    append(text, Vec3((mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).normalized()));
    for (const std::uint32_t v : t) append(text, mesh.vertices[v]);
    append(text, std::uint16_t{0});
  }
  return text;
}

TriangleMesh parse_stl(std::string_view text, const std::string& name, double scale, std::size_t* trailing_bytes) {
  if (is_binary(text, text.size())) return parse_binary(text, name, scale);
  if (begins_as_binary(text)) {
    const std::size_t trailing = bytes_after_triangles(text, text.size());
    if (trailing_bytes == nullptr || trailing == 0) refuse_length(text, text.size(), name);
    *trailing_bytes = trailing;
    return parse_binary(text, name, scale);
  }
  return parse_ascii(without_byte_order_mark(text), name, scale);
}

TriangleMesh read_stl(const std::filesystem::path& file, double scale, std::size_t* trailing_bytes) {
  const std::string name = file.string();
  std::error_code error;
  if (std::filesystem::is_regular_file(file, error)) {  // read_file() below reports other types of file
    require_short_file(file, kMaxDataBytes);
    std::string begin(binary_length(0), '\0');
    std::ifstream stream(file, std::ios::binary);
    stream.read(begin.data(), static_cast<std::streamsize>(begin.size()));
    begin.resize(static_cast<std::size_t>(stream.gcount()));
    const std::uintmax_t bytes = std::filesystem::file_size(file, error);
    const bool is_whole = !error && (is_binary(begin, bytes) || (trailing_bytes != nullptr && begins_as_binary(begin) &&
                                                                 bytes_after_triangles(begin, bytes) > 0));
    if (is_whole && binary_count(begin) > kMaxStlTriangles) refuse_count(name);
    if (!error && !is_whole && begins_as_binary(begin)) refuse_length(begin, bytes, name);
  }
  return parse_stl(read_file(file, kMaxDataBytes), name, scale, trailing_bytes);
}

}  // namespace retrace::geometry
