#pragma once

// Reads glass catalogues in the AGF format (Ansys Zemax OpticStudio), in which glass makers publish their data.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "materials/dispersion.h"

namespace retrace::materials {

/// Catalogue of glasses. A glass is parsed only when it is requested, so that an invalid glass does not affect the
/// others.
///
/// A record begins with a code of two capital letters. A line without a code continues the previous record. The
/// following records are read; other records have no effect:
/// NM (name, number of the formula, glass code, n_d), CD (coefficients of the formula), TD (thermo-optic coefficients
/// and the temperature of the data), LD (wavelength range in um), IT (wavelength in um, internal transmittance,
/// thickness in mm).
/// The text may be in ASCII, in an encoding that is a superset of ASCII, or in UTF-16 with a byte order mark. Indices
/// are relative to air.
class GlassCatalogue {
 public:
  /// \param file name of the file, for messages
  /// \throw InputError if the text contains no glass
  GlassCatalogue(std::string_view text, std::string file);
  /// Reads a catalogue from a file.
  /// \throw InputError if the file cannot be read or contains no glass
  static GlassCatalogue read(const std::filesystem::path& file);

  const std::vector<std::string>& names() const { return names_; }
  /// Checks that the catalogue contains a glass with this name. The case of letters is ignored.
  /// \throw InputError at `where` if there is no such glass
  void require(std::string_view name, const InputLocation& where) const;
  /// Returns the glass with this name. The material has warnings for samples of the transmittance that cannot be used,
  /// and for a value of n_d that differs from the index of the formula.
  /// \pre the catalogue contains a glass with this name
  /// \throw InputError with the file and line, if the formula is unknown, or if the records of the index are invalid or
  /// contradict each other
  Material glass(std::string_view name) const;

 private:
  struct Field {
    std::string text;
    int line = 0;

    bool operator==(const Field& other) const { return text == other.text; }
  };
  using Record = std::vector<Field>;  ///< fields of a record; the first field is the code

  [[noreturn]] void fail(int line, std::string_view key, std::string_view text) const;
  std::vector<double> numbers(const Record& record, std::size_t first, std::size_t min_count,
                              std::size_t max_count) const;
  void require_no_more(const Record& record, std::size_t max_count) const;
  void require_whole_pairs(const Record& record, std::size_t first, std::size_t end) const;
  const Record* find(const std::vector<Record>& records, std::string_view code) const;
  Dispersion dispersion(const Record& name, const Record& coefficients) const;
  void add_thermo_optic(const Record& record, Material& glass) const;
  void add_range(const Record& record, Material& glass) const;
  void add_absorption(const std::vector<Record>& records, Material& glass) const;
  void check_nd(const Record& name, Material& glass) const;
  Material glass_of(const std::vector<Record>& records) const;

  std::string file_;
  std::vector<std::string> names_;
  std::vector<std::vector<Record>> glasses_;  ///< records of each glass, beginning with its record NM
};

}  // namespace retrace::materials
