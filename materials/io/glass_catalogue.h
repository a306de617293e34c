#pragma once

// Reads catalogues of glass in the AGF format (Ansys Zemax OpticStudio), in which makers publish their glasses.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "materials/dispersion.h"

namespace retrace::materials {

/// A catalogue as its text: glasses are understood one by one, so that one that is not does not spoil the others.
///
/// Lines begin with two letters: NM (name, number of the formula), CD (its coefficients), TD (thermo-optic ones and the
/// temperature of the data), LD (range in um) and IT (wavelength in um, internal transmittance, thickness in mm) are
/// read; others mean nothing here. Text may be ASCII, any superset of it, or UTF-16 with a byte order mark. Indices are
/// relative to air.
class GlassCatalogue {
 public:
  /// \param file its name, for messages \throw InputError if the text holds no glass
  GlassCatalogue(std::string_view text, std::string file);
  /// \throw InputError also if the file cannot be read
  static GlassCatalogue read(const std::filesystem::path& file);

  const std::vector<std::string>& names() const { return names_; }
  /// Names are the same whatever the case of their letters. \throw InputError at `where` if there is no such glass
  void require(std::string_view name, const InputLocation& where) const;
  /// \pre there is such a glass \throw InputError naming the file and its line if it has a formula that is not known,
  /// or lines that cannot be understood
  Material glass(std::string_view name) const;

 private:
  struct Line {
    int number = 0;
    std::vector<std::string> fields;  ///< the two letters first
  };

  [[noreturn]] void fail(const Line& line, std::string_view text) const;
  std::vector<double> numbers(const Line& line, std::size_t first, std::size_t least, std::size_t most) const;
  Dispersion dispersion(const Line& name, const Line& coefficients) const;
  void add_thermo_optic(const Line& line, Material& glass) const;
  void add_range(const Line& line, Material& glass) const;
  SpectralCurve absorption(const std::vector<Line>& lines) const;
  Material glass_of(const std::vector<Line>& lines) const;

  std::string file_;
  std::vector<std::string> names_;
  std::vector<std::vector<Line>> glasses_;  ///< the lines of each, from its NM on
};

}  // namespace retrace::materials
