#pragma once

// Makes a design ready to trace: its part, its refractive indices, and the wavelengths that stand for its light.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "geometry/entrance/entrance_surface.h"
#include "geometry/part/chosen_elements.h"
#include "geometry/part/part.h"
#include "materials/io/material_library.h"
#include "raytrace/light/optics.h"
#include "studies/design/design.h"

namespace retrace::studies {

/// The optics at one of the wavelengths of a design's light.
struct SpectralOptics {
  double wavelength_nm = 0.0;
  double weight = 1.0;  ///< share of the flux that it stands for
  raytrace::Optics optics;
};

/// A design made ready to trace.
struct OpticalModel {
  geometry::Part part;
  /// That have another medium behind them, which `optics` know where they are some of all; null: the design has none.
  std::shared_ptr<const geometry::ChosenElements> wet_elements;
  std::optional<geometry::Entrance> entrance;  ///< in place of the plane entrance face; none: that plane
  double wavelength_nm = 0.0;                  ///< of the light; of a spectrum, its centroid
  raytrace::Optics optics;                     ///< at that of the wavelengths to trace which lies nearest to it
  std::vector<SpectralOptics> spectral;        ///< at the wavelengths to trace, ascending; their weights add to 1
  std::vector<std::string> warnings;           ///< what the user should know, such as an index outside its data
};

/// What a caller can trace: a plane entrance face alone, or a curved front as well.
enum class Entrances { plane, any };

/// Builds the part, looks up the material and resolves the spectrum of the light. \throw InputError naming file and
/// line for an unknown material, a spectrum that cannot be read, a wavelength at which the material has no index,
/// balls, which are no part, or a curved entrance surface unless `entrances` is any
OpticalModel make_model(const Design& design, const materials::MaterialLibrary& library,
                        Entrances entrances = Entrances::plane);

/// The same without the part: what can trace balls needs no more. \throw InputError likewise
OpticalModel make_light_model(const Design& design, const materials::MaterialLibrary& library);

/// The optics of a design at whatever wavelength they are asked for.
class OpticsOfDesign {
 public:
  /// Reads what does not depend on the wavelength. \param warnings what the user should know is added
  /// \pre `design` and `library` outlive it \throw InputError as make_model()
  OpticsOfDesign(const Design& design, const materials::MaterialLibrary& library, std::vector<std::string>& warnings);
  ~OpticsOfDesign();

  /// Without what lies behind single elements. \throw InputError where there are no data for it
  raytrace::Optics at(double wavelength_nm) const;
  /// The same of elements that have another medium behind them. \param chosen as OpticalModel::wet_elements
  raytrace::Optics at(double wavelength_nm, const std::shared_ptr<const geometry::ChosenElements>& chosen) const;
  /// Whether data back the index of the body there.
  bool is_backed_at(double wavelength_nm) const;
  /// What the body is made of.
  const materials::Material& material() const;

 private:
  struct Hidden;
  std::unique_ptr<const Hidden> hidden_;
};

}  // namespace retrace::studies
