// Reads files in Gwyddion's native format (http://gwyddion.net/documentation/user-guide-en/gwyfile-format.html). A file
// consists of the letters "GWYP" and one object. An object consists of its type, the number of its bytes, and its
// components. A component consists of its name, one letter for its type, and its value. Channel N is the component
// "/N/data" of the outermost object.

#include <cmath>
#include <map>

#include "core/field.h"
#include "surface_models/io/byte_reader.h"
#include "surface_models/io/raw_map.h"

namespace retrace::surface_models {
namespace {

struct Object {
  std::string_view type;
  ByteReader components;
};

Object read_object(ByteReader& bytes) {
  const std::string_view type = bytes.text();
  const std::uint32_t size = bytes.u32();
  return {type, bytes.part(size)};
}

/// Skips a value. Types of arrays are upper-case letters; an array begins with its number of items.
void skip_value(const Source& source, ByteReader& bytes, char type) {
  const auto skip_one = [&](char kind) {
    if (kind == 's') bytes.text();
    if (kind == 'o') read_object(bytes);
  };
  switch (type) {
    case 'b':
    case 'c': bytes.take(1); return;
    case 'i': bytes.take(4); return;
    case 'q':
    case 'd': bytes.take(8); return;
    case 's':
    case 'o': skip_one(type); return;
    case 'C': bytes.take(bytes.u32()); return;
    case 'I': bytes.take(std::uint64_t{4} * bytes.u32()); return;
    case 'Q':
    case 'D': bytes.take(std::uint64_t{8} * bytes.u32()); return;
    case 'S':
    case 'O':
      for (std::uint32_t left = bytes.u32(); left > 0; --left) skip_one(type == 'S' ? 's' : 'o');
      return;
    default:
      source.fail(0, fmt::format("a component before byte {} has the unknown type {}", bytes.at(),
                                 in_quotes(std::string_view(&type, 1))));
  }
}

/// Members of a GwyDataField that are used here.
struct DataField {
  std::uint32_t columns = 0;
  std::uint32_t rows = 0;
  double x_size = 0.0;  ///< in x_unit
  double y_size = 0.0;
  std::string_view lateral_unit;
  std::string_view height_unit;
  std::optional<ByteReader> heights;
  std::uint32_t count = 0;
};

std::string_view read_unit(const Source& source, ByteReader& bytes) {
  Object unit = read_object(bytes);
  std::string_view text;
  while (!unit.components.is_at_end()) {
    const std::string_view name = unit.components.text();
    const char type = unit.components.take(1)[0];
    if (name == "unitstr" && type == 's')
      text = unit.components.text();
    else
      skip_value(source, unit.components, type);
  }
  return text;
}

DataField read_field(const Source& source, ByteReader bytes) {
  DataField field;
  while (!bytes.is_at_end()) {
    const std::string_view name = bytes.text();
    const char type = bytes.take(1)[0];
    if (name == "xres" && type == 'i') {
      field.columns = bytes.u32();
    } else if (name == "yres" && type == 'i') {
      field.rows = bytes.u32();
    } else if (name == "xreal" && type == 'd') {
      field.x_size = bytes.f64();
    } else if (name == "yreal" && type == 'd') {
      field.y_size = bytes.f64();
    } else if (name == "si_unit_xy" && type == 'o') {
      field.lateral_unit = read_unit(source, bytes);
    } else if (name == "si_unit_z" && type == 'o') {
      field.height_unit = read_unit(source, bytes);
    } else if (name == "data" && type == 'D') {
      field.count = bytes.u32();
      field.heights = bytes.part(std::uint64_t{8} * field.count);
    } else {
      skip_value(source, bytes, type);
    }
  }
  return field;
}

/// Returns the channel number if `name` has the form "/N/data".
std::optional<std::size_t> channel_of(std::string_view name) {
  if (!name.starts_with('/') || !name.ends_with("/data") || name.size() < 7) return std::nullopt;
  const std::string_view digits = name.substr(1, name.size() - 6);
  if (digits.size() > 6 || digits.find_first_not_of("0123456789") != std::string_view::npos) return std::nullopt;
  return static_cast<std::size_t>(std::stoul(std::string(digits)));
}

/// All channels of a file, and whether any of them has a mask.
struct Channels {
  std::map<std::size_t, ByteReader> fields;
  bool has_mask = false;
};

Channels read_channels(const Source& source) {
  ByteReader bytes(source, source.content.substr(4), 4);
  Object container = read_object(bytes);
  Channels channels;
  while (!container.components.is_at_end()) {
    const std::string_view name = container.components.text();
    const char type = container.components.take(1)[0];
    const std::optional<std::size_t> channel = channel_of(name);
    if (channel && type == 'o') {
      const Object field = read_object(container.components);
      if (field.type == "GwyDataField") channels.fields.emplace(*channel, field.components);
    } else {
      channels.has_mask |= name.ends_with("/mask");
      skip_value(source, container.components, type);
    }
  }
  if (channels.fields.empty()) source.fail(0, "the file contains no channel (/0/data) with heights");
  return channels;
}

std::string names_of(const Channels& channels) {
  std::string names;
  for (const auto& [number, field] : channels.fields) names += (names.empty() ? "" : ", ") + std::to_string(number);
  return names;
}

double nm_per_or_fail(const Source& source, std::string_view unit, const char* what) {
  const std::optional<double> nm = nm_per(unit);
  if (!nm) source.fail(0, fmt::format("the unit of {} must be {}, got {}", what, kUnits, in_quotes(unit)));
  return *nm;
}

}  // namespace

RawMap parse_gwy(const Source& source) {
  const Channels channels = read_channels(source);
  const std::size_t wanted = source.options.channel.value_or(channels.fields.begin()->first);
  const auto found = channels.fields.find(wanted);
  if (found == channels.fields.end())
    source.fail(0, fmt::format("{}: must be a channel of the file ({}), got {}", reference({"channel"}),
                               names_of(channels), wanted));
  DataField field = read_field(source, found->second);

  RawMap raw;
  raw.format = "Gwyddion native (GWY)";
  check_size(source, 0, field.columns, field.rows);
  raw.columns = field.columns;
  raw.rows = field.rows;
  if (!field.heights || field.count != raw.columns * raw.rows)
    source.fail(
        0, fmt::format("channel {} must contain {} x {} heights, got {}", wanted, raw.columns, raw.rows, field.count));
  if (field.x_size > 0.0 && field.y_size > 0.0 && !field.lateral_unit.empty()) {
    const double um = nm_per_or_fail(source, field.lateral_unit, "lengths") / kNmPerUm;
    raw.x_pixel_um = field.x_size * um / field.columns;
    raw.y_pixel_um = field.y_size * um / field.rows;
  }
  if (!field.height_unit.empty()) raw.nm_per_unit = nm_per_or_fail(source, field.height_unit, "heights");
  raw.heights.reserve(raw.columns * raw.rows);
  for (std::size_t i = 0; i < raw.columns * raw.rows; ++i) {
    const double z = field.heights->f64();
    raw.heights.push_back(std::isfinite(z) ? z : kMissing);
  }
  if (channels.fields.size() > 1 && !source.options.channel)
    raw.warnings.push_back({"channel_chosen", fmt::format("channel {} of {} is used; choose another channel with {}",
                                                          wanted, names_of(channels), reference({"channel"}))});
  if (channels.has_mask)
    raw.warnings.push_back(
        {"masks_ignored", "masks in the file are ignored: the points that they cover count as measured"});
  return raw;
}

}  // namespace retrace::surface_models
