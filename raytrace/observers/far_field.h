#pragma once

// Far field of the returned light with Fraunhofer diffraction at the apertures of the cells. It is computed from the
// beams of the exact engine.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "core/progress.h"
#include "geometry/point_lookup.h"
#include "raytrace/exact/beam_tracer.h"
#include "raytrace/light/direction_score.h"
#include "raytrace/observers/aperture_field.h"
#include "raytrace/observers/cell_interference.h"
#include "raytrace/observers/scattered_field.h"

namespace retrace::raytrace {

class LatticeField;

/// Parameters of a far field.
struct FarFieldPolicy {
  bool diffraction = true;
  double wavelength_nm = 587.56;  ///< > 0
  /// Beams within this angle of the direction to the source are diffracted. Other beams keep their direction.
  double window_rad = 0.035;
  /// Maximum difference of optical paths at which light of one cell interferes. It allows for the coherence length of a
  /// lamp (a few um) and for the path differences that errors of angle cause.
  double coherence_length_mm = 0.02;
  /// Maximum fraction of the power in the window that is not diffracted, to save time. The weakest beams are selected.
  /// If there are few polygons, all beams are diffracted.
  double undiffracted_fraction = 1e-4;
  std::size_t max_polygons = 20'000;  ///< maximum number of diffracted polygons; weaker ones are not diffracted
  /// Minimum width of diffraction patterns that are computed. Light of cells with narrower patterns (larger cells) is
  /// not diffracted, because averaging over the discs of source and receiver hides these patterns.
  double finest_detail_rad = 0.0;
  /// Number of replicates of PopulationControl, or 0 without weak beams. A resampled beam does not interfere with other
  /// beams.
  std::uint32_t replicates = 0;
  /// Form of the retro facets (deviation from their planes) as in the tracer's optics; null if they are plane. It must
  /// outlive the collector. The form deflects diffracted light, and also the rays of cells that are too large to be
  /// diffracted.
  const surface_models::FacetForm* form = nullptr;
  /// Interference of the light of different cells of an infinite part. Without a value, and for finite parts, the
  /// intensities of different cells are added.
  std::optional<CellInterference> interference = {};
  /// Request for cancellation, which is checked between polygons. After a cancellation, all results are invalid. The
  /// object must outlive the far field. It may be null.
  const Cancellation* cancel = nullptr;
};

/// Undiffracted light, which has a single direction.
struct FarFieldRay {
  Vec3 direction;
  double power = 0.0;                           ///< power; if `replicate` is set, divided by the number of replicates
  std::optional<std::uint32_t> replicate = {};  ///< set for resampled beams
};

/// An intensity and its standard error, which is estimated from the spread of the replicates of resampled beams. An
/// interval of +-1.96 standard errors has a confidence of 95 %. The interference of resampled beams is not included.
struct FarFieldIntensity {
  double per_sr = 0.0;
  double error_per_sr = 0.0;  ///< 0 without replicates
};

/// Angular distribution of the light that leaves the entrance face, for one direction of incidence and one wavelength.
/// Powers are fractions of the incident power.
///
/// The fields of beams of one cell are added. The intensities of different cells are added. The reason is that the
/// heights of cells differ by more than the wavelength, and that the light of a lamp is coherent over less than the
/// width of a cell. By Fraunhofer diffraction at the entrance face, the far field of a beam is the Fourier transform of
/// its polygon.
///
/// Small cells that are cut with one height differ less. With FarFieldPolicy::interference, the far field consists of
/// diffraction orders of the array (LatticeField) and of diffuse light, which has the intensities of the cells. The
/// spread of the cells determines the fraction of both.
///
/// For beams that have met textures (ReturnedBeam::hits), the mean field is diffracted and the scattered light is added
/// (ScatteredField; docs/theory/photometry.md). Both are averages over all possible heights of the texture.
class FarField {
 public:
  /// Returns the intensity per steradian in a direction.
  /// \param kernel averages over the discs of source and receiver
  FarFieldIntensity intensity(const Vec3& direction, const ApertureKernel& kernel) const;
  /// Returns the intensity of only the diffracted light, per steradian, for a point source and a point receiver. This
  /// light consists of the mean field and of the interference fringes of scattered light. Diffraction orders of an
  /// array are not included, because the intensity of a point source in an order is infinite.
  double diffracted_per_sr(const Vec3& direction) const;
  std::vector<double> diffracted_per_sr(const std::vector<Vec3>& directions) const;
  /// Returns the intensity of only the lobes of scattered light, per steradian, for a point source and a point
  /// receiver.
  double scattered_per_sr(const Vec3& direction) const;
  /// Returns the intensity of only the lobes of scattered light, per steradian, averaged over the discs of source and
  /// receiver.
  double scattered_per_sr(const Vec3& direction, const ApertureKernel& kernel) const;

  /// Returns the power in each bin of a grid; the last element is the power outside of the grid. Undiffracted light is
  /// added to the bin of its direction. The power of diffracted light is its density at the centre of a bin times the
  /// solid angle of the bin. Each diffraction order of an array is added to the bin of its direction.
  std::vector<double> binned(const ReturnFrame& frame, const DirectionGrid& grid) const;

  /// Power inside and outside of the cone about the direction to the source. The two values are integrated
  /// independently of each other. `outside` includes the power that the theory predicts beyond the horizon.
  struct Split {
    double inside = 0.0;
    double outside = 0.0;
  };
  Split split(const ReturnFrame& frame, double half_angle_rad) const;

  double total_power() const { return total_power_; }
  double diffracted_power() const;
  /// Returns the power of all lobes of scattered light.
  double scattered_power() const { return scattered_.power(); }
  /// Returns the power of the lobes of scattered light within a cone about the direction to the source.
  double scattered_within(const ReturnFrame& frame, double half_angle_rad) const;
  /// Returns the scattered power of the weakest beams and of beams outside of the window. The directions of this light
  /// are not computed.
  double unplaced_power() const { return unplaced_power_; }
  /// Returns the power that is not diffracted because there are more polygons than `max_polygons`.
  double beyond_budget_power() const { return beyond_budget_power_; }
  /// Returns the angular width of the finest details of the diffracted light, or infinity if nothing is diffracted.
  double detail_rad() const;
  const std::vector<CoherentGroup>& groups() const { return groups_; }
  const std::vector<FarFieldRay>& rays() const { return rays_; }

 private:
  friend class FarFieldCollector;

  Eigen::ArrayXXd by_replicate(const std::vector<geometry::Vec2>& cosines, const ApertureField& field) const;
  Eigen::ArrayXd lobes_by_replicate(const Vec3& direction, const ApertureKernel& kernel) const;
  std::vector<double> per_cosines(const std::vector<geometry::Vec2>& cosines, const ApertureField& field) const;
  double tail(const ReturnFrame& frame, double half_angle_rad) const;
  Split split_orders(const ReturnFrame& frame, double half_angle_rad) const;
  double add_orders(const ReturnFrame& frame, const DirectionGrid& grid, std::vector<double>& bins) const;

  double wavelength_mm_ = 0.0;
  Eigen::Matrix2cd coherency_ = 0.5 * Eigen::Matrix2cd::Identity();
  std::vector<CoherentGroup> groups_;
  /// The groups of `groups_` as if all facets were plane. They are stored only if facets have a form. The form changes
  /// the direction cosines of light by at most `max_deflection_`. Far from the direction to the source, the field of
  /// `plane_groups_` is nearly that of `groups_`, and `plane_groups_` have fewer polygons.
  std::vector<CoherentGroup> plane_groups_;
  ApertureField field_;        ///< field of groups_
  ApertureField plane_field_;  ///< field of plane_groups_
  double max_deflection_ = 0.0;
  /// Diffraction orders of an array whose cells interfere. Null if the intensities of cells are added.
  std::shared_ptr<const LatticeField> lattice_;
  std::vector<FarFieldRay> rays_;
  ScatteredField scattered_;
  double unplaced_power_ = 0.0;
  double total_power_ = 0.0;
  double beyond_budget_power_ = 0.0;
  std::uint32_t replicates_ = 0;
  const Cancellation* cancel_ = nullptr;
};

/// Computes a far field from the returned beams of one direction of incidence.
/// \pre the beams are traced with BeamPolicy::separate_cells
class FarFieldCollector {
 public:
  /// \param illumination its Stokes parameters must have the power 1
  FarFieldCollector(const geometry::Part& part, const Illumination& illumination, const FarFieldPolicy& policy);

  void add(const ReturnedBeam& beam);
  /// Returns the far field of all beams.
  /// \throw BudgetError if the form requires too many polygons, see formed()
  FarField finish();

 private:
  /// A beam in the window (FarFieldPolicy::window_rad). It is moved, together with its cell, to the position of the
  /// first copy of the cell.
  struct CollectedBeam {
    geometry::Polygon outline_mm;
    Vec3 direction;
    JonesMatrix jones;
    double transmission = 0.0;
    double phase_mm = 0.0;
    double power = 0.0;
    double copies = 1.0;  ///< infinite parts: number of cells per period that return this beam
    std::vector<FieldHit> hits;
    std::optional<std::uint32_t> replicate;
    /// Maps a point of the entrance face where light leaves to the point where it entered. Both points are relative to
    /// the cell.
    Eigen::Affine2d entry_from_exit = Eigen::Affine2d::Identity();
    std::vector<geometry::Vec2>
        positions_mm;  ///< positions of the copies of the cell; see FarFieldPolicy::interference
  };
  /// Key of a wave: its direction, its field, and the points where it met facets with a form or a texture.
  using WaveKey = std::vector<std::int64_t>;
  /// Key of a coherent sum of fields: a cell, a wave that met several cells, or a resampled beam.
  struct CoherenceKey {
    std::uint64_t cell = 0;
    std::int64_t x = 0;
    std::int64_t y = 0;
    std::uint64_t beam = 0;
    auto operator<=>(const CoherenceKey&) const = default;
  };

  void add_ray(const FarFieldRay& ray);
  void add_scattering_ray(const FarFieldRay& ray, double phase_variance);
  double replicates_of(const ReturnedBeam& beam) const;
  CoherenceKey coherence_key_of(const ReturnedBeam& beam, const CollectedBeam& piece);
  void put(CollectedBeam piece, const ReturnedBeam& beam);
  WaveKey wave_of(const CollectedBeam& piece) const;
  CollectedBeam moved_to_first_copy(const ReturnedBeam& beam) const;
  /// Indices into beams_.
  using BeamsOfCell = std::vector<std::uint32_t>;
  geometry::Vec2 centroid_of(const BeamsOfCell& numbers) const;
  std::vector<CoherentGroup> groups_of(const BeamsOfCell& numbers, const geometry::Vec2& middle_mm) const;
  CoherentGroup group_of(std::vector<CollectedBeam> pieces, const geometry::Vec2& middle_mm) const;
  void join(std::vector<CollectedBeam>& pieces) const;
  std::vector<CoherentGroup> distinct_groups() const;
  void keep_strongest(std::vector<CoherentGroup> groups);
  /// \param has_lobes true if the scattered light of the group has been added to the far field
  void add_undiffracted(const CoherentGroup& group, bool has_lobes);

  FarFieldPolicy policy_;
  bool is_infinite_ = false;
  bool cells_interfere_ = false;
  geometry::Vec2 period_mm_ = geometry::Vec2::Zero();  ///< period of an infinite part
  double size_mm_ = 0.0;
  double thickness_mm_ = 0.0;
  Vec3 to_source_;
  FarField field_;
  /// Beams in the window. A beam that several cells have in common is stored one time.
  std::vector<CollectedBeam> beams_;
  std::map<CoherenceKey, BeamsOfCell> cells_;
  std::uint64_t unique_keys_ = 0;  ///< number of values of CoherenceKey::beam so far
  /// Values of CoherenceKey::beam, by CellTrail::sequence_hash and the key of a wave.
  std::map<std::pair<std::uint64_t, WaveKey>, std::uint64_t> mixed_;
  geometry::PointLookup<std::size_t> directions_;  ///< indices into FarField::rays()
};

}  // namespace retrace::raytrace
