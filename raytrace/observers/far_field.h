#pragma once

// The far field of returned light with Fraunhofer diffraction at the cells' apertures, from the beams of the exact
// engine.

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "core/progress.h"
#include "raytrace/exact/beam_tracer.h"
#include "raytrace/exact/point_lookup.h"
#include "raytrace/observers/aperture_field.h"
#include "raytrace/observers/direction_score.h"
#include "raytrace/observers/scattered_field.h"

namespace retrace::raytrace {

/// What a far field takes account of.
struct FarFieldPolicy {
  bool diffraction = true;
  double wavelength_nm = 587.56;  ///< > 0
  /// Beams within this angle of the direction back to the source are diffracted; the others stay where they go.
  double window_rad = 0.035;
  /// Light of one cell whose optical paths differ by more does not interfere: the coherence length of a lamp (a few um)
  /// and what the errors of angle of a part make of equal paths.
  double coherence_length_mm = 0.02;
  /// Maximum fraction of the power in the window that is treated without diffraction. The faintest beams are selected.
  /// If there are few polygons, all beams are diffracted.
  double undiffracted_share = 1e-4;
  std::size_t most_polygons = 20'000;  ///< that are diffracted; the faintest beyond are not
  /// Cells so large that their pattern is finer than this are not diffracted: the discs of source and receiver hide it.
  double finest_detail_rad = 0.0;
  /// Of WeakBeams, if their beams are added: resampled light interferes with none. 0: there are none.
  std::uint32_t replicates = 0;
  /// Of the retro facets, as the tracer's optics have it; null: they are plane. Outlives the collector. It bends what
  /// is diffracted, and the rays of cells that are not for their size.
  const surface_models::FacetForm* form = nullptr;
  /// Asked between polygons; figures of a far field are of no use once it is set. Outlives the far field.
  const Cancellation* cancel = nullptr;
};

/// Light in one direction, without a shape.
struct FarFieldRay {
  Vec3 direction;
  double power = 0.0;                           ///< of a replicate: over their number
  std::optional<std::uint32_t> replicate = {};  ///< of resampled beams
};

/// An intensity, and its standard error from the spread of the replicates of resampled beams: 1.96 of it hold the truth
/// in 95 of 100 cases, but for the interference of these beams.
struct FarFieldIntensity {
  double per_sr = 0.0;
  double error_per_sr = 0.0;  ///< 0 without replicates
};

/// Light that leaves the entrance face for one direction of incidence and one wavelength, by direction. Powers are
/// shares of the incident power.
///
/// Beams of one cell add their fields, cells add their intensities: cells of a mould differ in height by more than the
/// light can tell, and a lamp's light is coherent over less than a cell. Fraunhofer diffraction on the entrance face:
/// the far field of a beam is the Fourier transform of its polygon. Of beams that have met textures
/// (ReturnedBeam::hits) what their phases leave of the mean field is diffracted so, and what they scatter is added
/// (ScatteredField; docs/theory/photometry.md): means over all heights.
class FarField {
 public:
  /// What the receivers of `frame` see at angles (right, up), per steradian. \param kernel of source and receiver
  FarFieldIntensity intensity(const Vec3& direction, const ApertureKernel& kernel) const;
  /// The diffracted part alone, for a point as source and as receiver: the mean field, and the fringes of what
  /// scatters.
  double diffracted_per_sr(const Vec3& direction) const;
  std::vector<double> diffracted_per_sr(const std::vector<Vec3>& directions) const;
  /// The lobes of what scatters, likewise.
  double scattered_per_sr(const Vec3& direction) const;
  /// Mean over the discs of source and receiver.
  double scattered_per_sr(const Vec3& direction, const ApertureKernel& kernel) const;

  /// Power by the bins of a grid, and outside of it at the end. Undiffracted light goes where its direction is;
  /// diffracted light by its density in the middle of a bin.
  std::vector<double> binned(const ReturnFrame& frame, const DirectionGrid& grid) const;

  /// Power inside and outside of the cone about the direction back to the source, each by an integration of its own.
  /// Outside is also what the theory leaves beyond the horizon.
  struct Split {
    double inside = 0.0;
    double outside = 0.0;
  };
  Split split(const ReturnFrame& frame, double half_angle_rad) const;

  double total_power() const { return total_power_; }
  double diffracted_power() const;
  /// Of all lobes.
  double scattered_power() const { return scattered_.power(); }
  /// Of the lobes within a cone about the direction back to the source.
  double scattered_within(const ReturnFrame& frame, double half_angle_rad) const;
  /// Scattered by beams outside of the window and by the faintest: where it goes is not known.
  double unplaced_power() const { return unplaced_power_; }
  /// What would have been diffracted, were there not more polygons than `most_polygons`.
  double beyond_budget_power() const { return beyond_budget_power_; }
  /// Distance of the finest details of what is diffracted; infinite if nothing is.
  double detail_rad() const;
  const std::vector<CoherentGroup>& groups() const { return groups_; }
  const std::vector<FarFieldRay>& rays() const { return rays_; }

 private:
  friend class FarFieldCollector;

  Eigen::ArrayXXd by_replicate(const std::vector<geometry::Vec2>& cosines, const ApertureField& field) const;
  Eigen::ArrayXd lobes_by_replicate(const Vec3& direction, const ApertureKernel& kernel) const;
  std::vector<double> per_cosines(const std::vector<geometry::Vec2>& cosines, const ApertureField& field) const;
  double tail(const ReturnFrame& frame, double half_angle_rad) const;

  double wavelength_mm_ = 0.0;
  Eigen::Matrix2cd coherency_ = 0.5 * Eigen::Matrix2cd::Identity();
  std::vector<CoherentGroup> groups_;
  /// The same of plane facets, where these have a form that turns light by `bend_` at most: far from the light they
  /// send out nothing else, and they have fewer polygons.
  std::vector<CoherentGroup> plane_groups_;
  ApertureField field_;        ///< of groups_
  ApertureField plane_field_;  ///< of plane_groups_
  double bend_ = 0.0;
  std::vector<FarFieldRay> rays_;
  ScatteredField scattered_;
  double unplaced_power_ = 0.0;
  double total_power_ = 0.0;
  double beyond_budget_power_ = 0.0;
  std::uint32_t replicates_ = 0;
  const Cancellation* cancel_ = nullptr;
};

/// Makes a far field of the returned beams of one direction, which BeamPolicy::by_cell keeps apart.
class FarFieldCollector {
 public:
  /// \param illumination whose Stokes parameters are of power 1
  FarFieldCollector(const geometry::Part& part, const Illumination& illumination, const FarFieldPolicy& policy);

  void add(const ReturnedBeam& beam);
  /// \throw BudgetError if the form takes too many pieces (formed())
  FarField finish();

 private:
  /// A beam in the window, moved with its cell to where the first copy of the cell stands.
  struct Piece {
    geometry::Polygon outline_mm;
    Vec3 direction;
    JonesMatrix jones;
    double transmission = 0.0;
    double phase_mm = 0.0;
    double power = 0.0;
    double copies = 1.0;  ///< in an endless part: cells of a period that send it back
    std::vector<FieldHit> hits;
    std::optional<std::uint32_t> replicate;
  };
  /// What tells waves apart: where they go, with which field, and where they met facets that bend or scatter them.
  using WaveKey = std::vector<std::int64_t>;
  /// One cell; of light that met several, that of one wave by the same cells; of a resampled beam, the beam itself.
  struct Place {
    std::uint64_t cell = 0;
    std::int64_t x = 0;
    std::int64_t y = 0;
    std::uint64_t beam = 0;
    auto operator<=>(const Place&) const = default;
  };

  void add_ray(const FarFieldRay& ray);
  void add_scattering_ray(const FarFieldRay& ray, double phase_variance);
  double replicates_of(const ReturnedBeam& beam) const;
  Place place_of(const ReturnedBeam& beam, const Piece& piece);
  void put(Piece piece, const ReturnedBeam& beam);
  WaveKey wave_of(const Piece& piece) const;
  Piece moved_home(const ReturnedBeam& beam) const;
  /// Numbers of pieces.
  using PiecesOfCell = std::vector<std::uint32_t>;
  geometry::Vec2 middle_of(const PiecesOfCell& numbers) const;
  std::vector<CoherentGroup> groups_of(const PiecesOfCell& numbers, const geometry::Vec2& middle_mm) const;
  CoherentGroup group_of(std::vector<Piece> pieces, const geometry::Vec2& middle_mm) const;
  void join(std::vector<Piece>& pieces) const;
  std::vector<CoherentGroup> distinct_groups() const;
  void keep_strongest(std::vector<CoherentGroup> groups);
  /// \param has_lobes whether what it scatters is kept
  void add_undiffracted(const CoherentGroup& group, bool has_lobes);

  FarFieldPolicy policy_;
  bool is_infinite_ = false;
  double size_mm_ = 0.0;
  double thickness_mm_ = 0.0;
  Vec3 to_source_;
  FarField field_;
  /// In the places that they belong to; one that beams of several cells share is there once.
  std::vector<Piece> pieces_;
  std::map<Place, PiecesOfCell> cells_;
  std::uint64_t alone_ = 0;                                           ///< waves and beams that are a place of their own
  std::map<std::pair<std::uint64_t, WaveKey>, std::uint64_t> mixed_;  ///< their numbers, by CellTrail::met
  PointLookup<std::size_t> directions_;                               ///< indices into the rays
};

}  // namespace retrace::raytrace
