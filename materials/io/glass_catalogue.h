#pragma once

// Reads catalogues of glass in the AGF format (Ansys Zemax OpticStudio), in which makers publish their glasses.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "materials/dispersion.h"

namespace retrace::materials {

/// A catalogue of glasses. Each glass is parsed only when it is requested. An invalid glass therefore does not affect
/// the others.
///
/// Records begin with a code of two capital letters. NM (name, number of the formula, glass code, n_d), CD
/// (coefficients of the formula), TD (thermo-optic coefficients and the temperature of the data), LD (range in um) and
/// IT (wavelength in um, internal transmittance, thickness in mm) are read; other records have no effect. A line
/// without a code continues the record before it. Text may be ASCII, any superset of it, or UTF-16 with a byte order
/// mark. Indices are relative to air.
class GlassCatalogue {
 public:
  /// \param file name of the file, for messages
  /// \throw InputError if the text contains no glass
  GlassCatalogue(std::string_view text, std::string file);
  /// \throw InputError also if the file cannot be read
  static GlassCatalogue read(const std::filesystem::path& file);

  const std::vector<std::string>& names() const { return names_; }
  /// Checks that a glass with this name exists. Upper and lower case are not distinguished.
  /// \throw InputError at `where` if there is no such glass
  void require(std::string_view name, const InputLocation& where) const;
  /// Returns the glass with this name. The warnings of the material report samples of the transmittance that cannot be
  /// used, and a value of n_d that differs from the index of the formula.
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
  std::vector<double> numbers(const Record& record, std::size_t first, std::size_t least, std::size_t most) const;
  void require_no_more(const Record& record, std::size_t most) const;
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
