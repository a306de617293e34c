#pragma once

// Software goniophotometer: measures R_A and R_L of a design for given directions of light and observation.

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/warning.h"
#include "design/optical_model.h"
#include "raytrace/observers/far_field.h"
#include "raytrace/observers/photometric_geometry.h"
#include "raytrace/observers/tangent_error.h"
#include "studies/photometry/photometry.h"
#include "studies/rre/equivalent_directions.h"

namespace retrace::raytrace {
class MonteCarlo;
}

namespace retrace::studies {

/// Geometry of one measurement: a direction of light and several observation angles.
struct PhotometerSetting {
  double v_deg = 0.0, h_deg = 0.0, rotation_deg = 0.0;
  std::vector<double> observation_deg;
  std::size_t map_columns = 0;  ///< number of columns of the map; 0: no map
  bool split = false;
  /// Direction H = V = 0 in the part frame (Design::reference_axis()). Photometer::measure() sets it.
  geometry::Vec3 reference_axis = geometry::Vec3::UnitZ();
};

raytrace::PhotometricGeometry geometry_of(const PhotometerSetting& setting, double observation_deg);
/// Returns the setting for one direction of light and one direction of observation.
/// \param directions directions in the part frame
/// \param reference_axis direction H = V = 0 in the part frame
PhotometerSetting setting_of(const raytrace::PhotometricDirections& directions,
                             const geometry::Vec3& reference_axis = geometry::Vec3::UnitZ());
/// Returns the frame of directions around the direction back to the source, in the part frame.
raytrace::ReturnFrame frame_of(const PhotometerSetting& setting);

/// Spectral response of the receiver: a colour matching function of the CIE 1931 observer. y_bar is V(lambda).
enum class PhotometricResponse { x_bar, y_bar, z_bar };

struct PhotometerReading {
  std::vector<double> r_a;  ///< R_A for each observation angle, in cd/(lx m^2)
  std::vector<double> r_l;
  std::vector<double> r_a_error;
  PhotometricDirection direction;
  std::vector<double> map_r_a;
  bool lacks_diffraction = false;  ///< true: diffraction is significant but not included in the reading
  /// Tangent-plane model of a curved entrance surface. Empty behind a plane entrance face, and if rays are traced.
  std::optional<EntranceModel> entrance_model;
};

/// Measures the coefficients of retroreflection of a design, as a goniophotometer does. Each direction of incidence is
/// measured separately. Wavelengths are weighted by the lamp's power and the response of the receiver.
class Photometer {
 public:
  /// \param parts number of spans of the lamp's spectrum, with two wavelengths each
  /// \param response response of the receiver; values are relative to its response to the light that falls on the part
  /// \throw InputError in the same cases as make_model()
  Photometer(const design::Design& design, const PhotometrySettings& request, std::size_t parts,
             PhotometricResponse response = PhotometricResponse::y_bar);

  /// Measures all settings. Returns the readings in the order of the settings, or nothing if the measurement was
  /// cancelled. The angles of the settings are relative to the reference axis of the design.
  /// \throw InputError if the entrance face is inclined and the light of a setting comes from behind the plane z = 0
  std::optional<std::vector<PhotometerReading>> measure(const std::vector<PhotometerSetting>& requested,
                                                        Progress* progress, const Cancellation* cancel) const;

  /// Far field at one wavelength, and the weight of this wavelength in the response of the receiver.
  struct WeightedField {
    raytrace::FarField field;
    double weight = 0.0;
  };
  /// Computes the far fields at all wavelengths for light from one direction. Returns nothing if the computation was
  /// cancelled.
  /// \param tracer result of make_tracer()
  /// \pre is_exact()
  std::optional<std::vector<WeightedField>> far_fields(const geometry::Vec3& to_source,
                                                       const raytrace::BeamTracer& tracer,
                                                       const Cancellation* cancel) const;
  /// Returns a beam tracer that several threads may use at the same time. The tracer refers to this photometer, so the
  /// photometer must exist as long as the tracer.
  raytrace::BeamTracer make_tracer() const;
  const raytrace::ApertureKernel& kernel() const { return kernel_; }

  /// Returns two values, for the axes x and y. A value is true if the reflection that reverses this axis is one of
  /// design::light_symmetries().
  std::array<bool, 2> mirrors() const;
  /// Makes later calls of group_equivalent_settings() and measure() use all symmetries of the part. By default, only
  /// reflections of the axes x and y are used.
  void share_rotations() { shares_rotations_ = true; }
  /// Groups the settings. All settings of a group can be measured from one traced far field.
  std::vector<EquivalentDirections> group_equivalent_settings(const std::vector<PhotometerSetting>& settings) const;

  const Warnings& warnings() const { return model_.warnings; }
  std::vector<double> wavelengths_nm() const;
  std::string engine_name() const;
  /// Returns the cut-off power, as a fraction of the power that falls on one element. Weaker beams are resampled or
  /// truncated.
  double cutoff_of_element() const;
  /// Returns advice for reducing standard errors, for messages.
  std::string remedy_for_noise() const { return is_exact() ? "give a lower cut-off" : "give more samples"; }
  bool has_diffraction() const { return is_exact() && request_.diffraction; }
  /// Returns true if the fields of different cells are added (design::CellSpread).
  bool adds_fields_of_cells() const { return has_diffraction() && design_.cell_spread() != nullptr; }
  /// Returns the reason why the readings do not include diffraction.
  /// \pre the readings do not include diffraction
  NoDiffraction why_undiffracted() const;
  /// Returns the smallest cell width, in mm, for which diffraction is not significant.
  double min_undiffracted_mm() const;
  /// Returns a photometer that measures, with diffraction, only the mean field of a part with rough facets: the field
  /// averaged over the random heights, without scattered light. The current photometer measures the part by rays,
  /// without diffraction. The mean field is nowhere brighter than the light that the part really returns. Readings of
  /// the returned photometer are therefore lower bounds (docs/theory/photometry.md). Returns nothing for parts without
  /// rough facets and for parts whose mean field cannot be traced exactly. Also returns nothing if the request selects
  /// another engine or no diffraction.
  std::optional<Photometer> mean_field() const;
  /// Makes later measurements use Monte Carlo.
  void use_monte_carlo() { tracing_ = Tracing::rays; }
  bool is_exact() const { return tracing_ != Tracing::rays; }
  /// Trade-off between accuracy and duration of later measurements.
  enum class Effort {
    full,
    /// Fewer resampled beams represent the weak beams. Such values may guide a search, but must not be shown to the
    /// user.
    search,
    /// Preliminary values that are shown with their errors. As with `search`, fewer resampled beams are used. The
    /// cut-off power of beams is also higher. Another photometer measures the part at the same time, so that the search
    /// structures of the part may use at most half of their memory budget.
    first_answer
  };
  void set_effort(Effort effort) { effort_ = effort; }
  /// Sets the cut-off power of later measurements, as a fraction of the power that falls on one element. It replaces
  /// that of the request.
  /// \param cutoff > 0
  void set_cutoff_of_element(double cutoff) { request_.cutoff = cutoff; }
  /// Ignores the mirror image of the light in later measurements. The mirror image is the light that the entrance face
  /// reflects, either at its outer side, or at its inner side between two retroreflections by elements.
  /// \pre is_exact()
  void ignore_mirror_image() { has_mirror_image_ = false; }
  /// Ignores, in later measurements by beams, the light that the entrance face reflects at its outer side. Measurements
  /// by rays are not changed.
  void ignore_front_reflection() { has_front_reflection_ = false; }
  /// Returns the number of independent replicates of resampled beams.
  std::uint32_t replicates() const;
  /// Makes later measurements use geometrical optics, without diffraction.
  void ignore_diffraction();
  /// Returns the optical model at each traced wavelength.
  const std::vector<design::SpectralOptics>& optics() const { return model_.spectral; }
  /// Returns the weights of the traced wavelengths in the response of the receiver. They do not include the absorption
  /// in the body. In a coloured body, their sum may differ from 1.
  const std::vector<double>& weights() const { return weights_; }
  /// Returns the width of the cells whose edges diffract light, or 0 if it is not known.
  double cell_width_mm() const;

 private:
  /// Lamp of the measurement, with all data that determine the traced wavelengths.
  struct Lamp {
    materials::SpectralCurve power;
    materials::SpectralCurve response;           ///< spectral response of the receiver
    materials::SpectralCurve absorption_per_mm;  ///< absorption coefficient of the body
    double path_length_mm = 0.0;                 ///< path length of returned light inside the part
    std::size_t parts = 1;                       ///< number of spans of the spectrum, each with two wavelengths

    /// Returns the transmittance of the body for a path of `path_length_mm`.
    double transmittance(double wavelength_nm) const;
    /// Returns the spectral power that remains after absorption in the body, per nm.
    materials::SpectralCurve remaining_power() const;
    /// Returns the traced wavelengths and their weights. The weights do not include the absorption in the body.
    /// \param knees_nm wavelengths at which total reflection begins or ends at a facet, in ascending order
    materials::Spectrum light(const std::vector<double>& knees_nm) const;
  };
  /// Contribution of one wavelength to a reading.
  struct WavelengthReading {
    std::vector<double> per_sr;
    std::vector<double> error_per_sr;
    /// Estimate of the intensity that is missing in `per_sr`, for each observation angle. Light is missing if its beam
    /// was truncated, or if it was scattered into unknown directions. An empty vector means that no light is missing.
    std::vector<double> missing_per_sr;
    std::vector<double> map_per_sr;
    double rre = 0.0;
    double std_error = 0.0;
    double truncated = 0.0;
    std::optional<PhotometricDirection::Split> split;
    double beyond_budget = 0.0;  ///< power whose diffraction is omitted because the budget of polygons is exhausted
    bool complete = false;
  };
  /// Method by which light is traced.
  enum class Tracing {
    beams,       ///< all light as beams; the light that rough facets scatter is described by random phases
    mean_field,  ///< beams without the light that rough facets scatter; readings are lower bounds
    rays         ///< Monte Carlo
  };
  /// Minimum width of cells for which diffraction need not be computed, in units of the wavelength divided by the
  /// angular diameter of the discs (apertures of source and receiver). For wider cells, diffraction carries less than 1
  /// % of the light past the edge of a disc (docs/theory/photometry.md).
  static constexpr double kWidthsWithoutDiffraction = 64.0;

  raytrace::FarFieldPolicy far_field_policy(const design::SpectralOptics& light, const Cancellation* cancel) const;
  /// Returns the parameters with which the fields of different cells are added, at one wavelength. Returns nothing if
  /// their intensities are added.
  std::optional<raytrace::CellInterference> cell_interference(std::size_t wavelength) const;
  /// Returns the settings of the beam tracer for one wavelength.
  /// \param coarseness factor by which the cut-off power is multiplied
  raytrace::BeamPolicy beam_policy(std::size_t wavelength, double coarseness) const;
  /// Result of tracing the light of one wavelength.
  struct Traced {
    raytrace::BeamResult beams;
    raytrace::FarField field;
    double scattered_from_cone = 0.0;  ///< power that rough facets scatter out of the detector's widest acceptance cone
  };
  /// Traces the light of one wavelength. Returns nothing if the computation was cancelled.
  /// \param coarseness factor by which the cut-off power is multiplied
  std::optional<Traced> traced(const geometry::Vec3& to_source, std::size_t wavelength,
                               const raytrace::BeamTracer& tracer, const Cancellation* cancel,
                               double coarseness = 1.0) const;
  /// Measures all settings whose light comes from one direction, from a single traced far field. Returns one reading
  /// for each element of `directions`, in this order.
  std::vector<WavelengthReading> measure_exactly(const std::vector<PhotometerSetting>& settings,
                                                 const EquivalentDirections& directions, std::size_t wavelength,
                                                 const raytrace::BeamTracer& tracer, const Cancellation* cancel) const;
  /// Returns true if beams record random phases, which describe the light that rough facets scatter.
  bool keeps_phases() const { return tracing_ == Tracing::beams && facts_.has_texture; }
  void estimate_missing(const std::vector<PhotometerSetting>& settings, const EquivalentDirections& directions,
                        std::size_t wavelength, const Traced& traced, const raytrace::BeamTracer& tracer,
                        const Cancellation* cancel, std::vector<WavelengthReading>& pieces) const;
  void read_far_field(const PhotometerSetting& setting, const SharedDirection& shared, const raytrace::FarField& field,
                      std::size_t wavelength, WavelengthReading& piece) const;
  /// Measures one setting at one wavelength by ray tracing.
  /// \param tracer ray tracer of the part; null for balls, which have their own tracer
  WavelengthReading measure_by_rays(const PhotometerSetting& setting, std::size_t wavelength,
                                    const raytrace::MonteCarlo* tracer, Progress& progress,
                                    const Cancellation* cancel) const;
  /// Measures all settings by ray tracing. Returns false if the measurement was cancelled.
  /// \param pieces receives the contributions of all wavelengths, with the indices [setting][wavelength]
  bool measure_by_rays(const std::vector<PhotometerSetting>& settings, Progress* progress, const Cancellation* cancel,
                       std::vector<std::vector<WavelengthReading>>& pieces) const;
  /// Groups the settings by their knees and returns the indices of the settings in each group. Knees are the
  /// wavelengths at which total reflection begins or ends at a facet for light from the source of the setting.
  std::map<std::vector<double>, std::vector<std::size_t>> settings_by_knees(
      const std::vector<PhotometerSetting>& settings) const;
  /// Returns a copy of this photometer that traces the wavelengths of Lamp::light() for the given knees.
  Photometer with_knees(const std::vector<double>& knees_nm) const;
  /// Measures all settings at the wavelengths of `model_`. The knees of the settings are ignored.
  std::optional<std::vector<PhotometerReading>> measure_in_one_light(const std::vector<PhotometerSetting>& settings,
                                                                     Progress* progress,
                                                                     const Cancellation* cancel) const;
  /// Returns copies of the settings that contain the reference axis of the design.
  /// \throw InputError if the light of a setting comes from behind the plane z = 0
  std::vector<PhotometerSetting> with_reference_axis(std::vector<PhotometerSetting> settings) const;
  /// \param weights weights of the readings in `pieces`
  PhotometerReading reading_of(const PhotometerSetting& setting, const std::vector<WavelengthReading>& pieces,
                               const std::vector<double>& weights) const;
  /// Returns true if light is traced as beams through tangent planes of a curved entrance surface.
  bool uses_tangent_planes() const { return is_exact() && model_.entrance.has_value(); }
  /// Samples, traces and sums the light of elements for measure_behind_surface().
  class SurfaceMeasurement;
  /// Measures all settings behind a curved entrance surface. Beams are traced at a sample of the elements. Returns
  /// nothing if the measurement was cancelled.
  std::optional<std::vector<PhotometerReading>> measure_behind_surface(const std::vector<PhotometerSetting>& settings,
                                                                       Progress* progress,
                                                                       const Cancellation* cancel) const;
  /// Adds the light that the curved entrance surface reflects at its outer side. `sum` is the sum over all wavelengths.
  void add_surface_reflection(const PhotometerSetting& setting, const SharedDirection& shared,
                              const raytrace::ElementLight& elements, WavelengthReading& sum) const;
  /// Returns the transmittance of the body at one wavelength, for the typical length of the path of returned light.
  double body_transmittance(std::size_t wavelength) const;
  std::size_t max_element_samples(const std::vector<PhotometerSetting>& settings) const;
  bool resamples_weak() const;   ///< true: beams below the cut-off power are resampled; false: they are truncated
  double element_count() const;  ///< number of elements over which the light is distributed, >= 1
  double cutoff() const;

  design::Design design_;
  PhotometrySettings request_;
  design::OpticalModel model_;
  std::optional<Lamp> lamp_;  ///< empty if the spectrum of the design is used
  /// Weights of the wavelengths by flux. They do not include the absorption in the dye, because the tracer applies it.
  std::vector<double> weights_;
  raytrace::ApertureKernel kernel_;
  raytrace::EngineFacts facts_;
  Tracing tracing_ = Tracing::rays;
  Effort effort_ = Effort::full;
  bool has_mirror_image_ = true;
  bool has_front_reflection_ = true;
  bool shares_rotations_ = false;  ///< see share_rotations()
};

/// Returns the design with the absorption of a dye in its body. Returns the same design if the curve is empty.
design::Design with_dye(design::Design design, const materials::SpectralCurve& absorption_per_mm);

/// Returns the relative spectral power of a CIE illuminant, per nm.
/// \pre `light` is not the design's own light
materials::SpectralCurve lamp_power(PhotometricLight light);

}  // namespace retrace::studies
