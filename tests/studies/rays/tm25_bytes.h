#pragma once

// Writes and reads TM-25 ray files byte by byte. This implementation of the format is used only by tests and shares no
// code with the program.

#include <array>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace retrace::testing::tm25_bytes {

/// Contents of a file, in the order of the file.
struct File {
  std::string magic = "TM25";
  std::int32_t version = 2013;
  float luminous = 0.0F;
  float radiant = 0.0F;
  std::uint64_t rays = 0;
  std::string date;
  std::int32_t spectral_identifier = 0;
  float wavelength = 0.0F;
  float min_wavelength = 0.0F;
  float greatest_wavelength = 0.0F;
  /// Flags for the items of each ray: position, direction, radiant flux, wavelength, luminous flux, Stokes parameters,
  /// tristimulus values, spectrum index.
  std::array<std::int32_t, 8> flags = {1, 1, 1, 0, 0, 0, 0, 0};
  std::array<std::u32string, 9> texts;
  std::vector<std::vector<std::pair<float, float>>> tables;
  std::vector<std::u32string> items;
  std::u32string more;
  std::vector<std::vector<float>> values;  ///< values of each ray

  std::size_t columns() const {
    static constexpr std::array<std::size_t, 8> width = {3, 3, 1, 1, 1, 6, 2, 1};
    std::size_t sum = items.size();
    for (std::size_t k = 0; k < flags.size(); ++k) sum += flags[k] != 0 ? width[k] : 0;
    return sum;
  }
};

template <class Value>
void put(std::string& bytes, Value value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

inline void put_text(std::string& bytes, const std::u32string& text, std::size_t size) {
  const std::size_t end = bytes.size() + size;
  for (const char32_t c : text) put(bytes, static_cast<std::uint32_t>(c));
  bytes.resize(end, '\0');
}

inline std::string bytes_of(const File& file) {
  std::string bytes = file.magic;
  put(bytes, file.version);
  put(bytes, std::int32_t{1});
  put(bytes, file.luminous);
  put(bytes, file.radiant);
  put(bytes, file.rays > 0 ? file.rays : static_cast<std::uint64_t>(file.values.size()));
  bytes += file.date;
  bytes.resize(56, '\0');
  put(bytes, std::int32_t{0});
  put(bytes, file.spectral_identifier);
  put(bytes, file.wavelength);
  put(bytes, file.min_wavelength);
  put(bytes, file.greatest_wavelength);
  put(bytes, static_cast<std::int32_t>(file.tables.size()));
  put(bytes, static_cast<std::int32_t>(file.items.size()));
  const std::size_t more_bytes = (4 * file.more.size() + 31) / 32 * 32;
  put(bytes, static_cast<std::int32_t>(more_bytes));
  bytes.resize(256, '\0');
  for (const std::int32_t flag : file.flags) put(bytes, flag);
  for (const std::u32string& text : file.texts) put_text(bytes, text, 4000);
  const std::size_t begin = bytes.size();
  for (const auto& table : file.tables) {
    put(bytes, static_cast<std::int32_t>(table.size()));
    for (const auto& [wavelength, weight] : table) {
      put(bytes, wavelength);
      put(bytes, weight);
    }
  }
  while ((bytes.size() - begin) % 32 != 0) bytes.push_back('\0');
  for (const std::u32string& item : file.items) put_text(bytes, item, 512);
  put_text(bytes, file.more, more_bytes);
  for (const auto& row : file.values)
    for (const float value : row) put(bytes, value);
  return bytes;
}

/// Reads a file.
/// \pre the file is valid and has no spectral tables
inline File file_of(const std::string& bytes) {
  std::size_t at = 0;
  const auto take = [&]<class Value>(Value& value) {
    if (at + sizeof value > bytes.size()) throw std::out_of_range("cut short");
    std::memcpy(&value, bytes.data() + at, sizeof value);
    at += sizeof value;
  };
  const auto take_text = [&](std::size_t size) {
    std::u32string text;
    for (std::size_t k = 0; k < size; k += 4) {
      std::uint32_t c = 0;
      std::memcpy(&c, bytes.data() + at + k, 4);
      if (c == 0) break;
      text.push_back(c);
    }
    at += size;
    return text;
  };
  File file;
  file.magic = bytes.substr(0, 4);
  at = 4;
  take(file.version);
  at = 12;
  take(file.luminous);
  take(file.radiant);
  take(file.rays);
  file.date = bytes.substr(28, 28).c_str();
  at = 60;
  take(file.spectral_identifier);
  take(file.wavelength);
  take(file.min_wavelength);
  take(file.greatest_wavelength);
  std::int32_t tables = 0;
  std::int32_t items = 0;
  std::int32_t more_bytes = 0;
  take(tables);
  take(items);
  take(more_bytes);
  at = 256;
  for (std::int32_t& flag : file.flags) take(flag);
  for (std::u32string& text : file.texts) text = take_text(4000);
  for (std::int32_t k = 0; k < items; ++k) file.items.push_back(take_text(512));
  if (more_bytes % 32 != 0) throw std::out_of_range("the additional text fills no blocks");
  file.more = take_text(static_cast<std::size_t>(more_bytes));
  for (std::uint64_t ray = 0; ray < file.rays; ++ray) {
    std::vector<float> row(file.columns());
    for (float& value : row) take(value);
    file.values.push_back(row);
  }
  if (at != bytes.size()) throw std::out_of_range("bytes are left");
  return file;
}

}  // namespace retrace::testing::tm25_bytes
