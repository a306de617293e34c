#pragma once

// The exact engine. It traces polygonal beams through a part without sampling. Its results are the RRE (retroreflective
// efficiency), the ledger (power by destination) and every returned beam.

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/progress.h"
#include "geometry/part/part.h"
#include "raytrace/exact/beam.h"
#include "raytrace/exact/translational_symmetry.h"
#include "raytrace/faces/cell_index.h"
#include "raytrace/light/light_setup.h"

namespace retrace::raytrace {

struct BeamScene;
struct ExcerptLight;
class BeamWalk;

/// Default of BeamPolicy::truncated_goal: maximum power that is not traced. It is much smaller than other errors.
inline constexpr double kFinestGoal = 1e-10;

/// Ratio of the maximum power of a survivor of resampling to the cut-off. It is large, because each strong beam is
/// traced only one time, but survivors are traced in every replicate.
inline constexpr double kSurvivorPowerRatio = 32.0;

/// Parameters of the resampling of beams below the cut-off (BeamGeneration). The mean over the replicates has no bias,
/// and the standard error is estimated from the spread of the replicates.
struct PopulationControl {
  std::uint32_t seed = 1;
  std::uint32_t replicates = 16;                      ///< >= 2
  double survivor_power_ratio = kSurvivorPowerRatio;  ///< maximum power of a survivor as a multiple of the cut-off
};

/// Criteria that end the tracing of beams.
struct BeamPolicy {
  /// Minimum power of a beam that is traced. In a finite part, the powers of identical beams at identical elements are
  /// added for this comparison. Without a value, the cut-off starts at 100 times `truncated_goal`, limited to the range
  /// from 1e-6 to 1e-3. It then decreases until the truncated power is at most `truncated_goal`.
  std::optional<double> cutoff;
  /// Resampling of the beams whose power is below `cutoff`. Without a value, these beams are not traced further and
  /// their power is added to `truncated`. Only BeamTracer::trace() supports resampling.
  /// \pre `cutoff` is set and all facets are plane; rough facets require `keeps_phases`
  std::optional<PopulationControl> population_control;
  double truncated_goal = kFinestGoal;
  /// Amount of BeamTrace::work() up to which tracing continues even after `truncated_goal` is reached. Tracing then
  /// ends when the truncated power is at most `kFinestGoal`. Fast traces become more accurate in this way.
  std::uint64_t spare_work = 0;
  std::uint64_t max_beams = 100'000'000;  ///< maximum number of traced beams, including the search for the cut-off
  /// If true, facets of neighbouring cells are treated separately even if they are in one plane. Every returned beam
  /// then belongs to one cell.
  bool separate_cells = false;
  /// If true, textured facets do not remove scattered light from the beams. Every returned beam contains the list of
  /// the textured facets that it has met, from which the far field computes specular and scattered light. It is allowed
  /// only for textures for which has_phases() is true.
  bool keeps_phases = false;
  /// Selects the traced light if the part is an excerpt of a larger part; null for a complete part. It must outlive the
  /// trace.
  const ExcerptLight* excerpt = nullptr;
};

struct BeamResult {
  std::vector<Ledger> ledgers;  ///< one per acceptance cone, in the order given
  std::vector<Stokes> stokes;   ///< Stokes vectors of the retroreflected light per cone; first axis: source_axis()
  /// Standard error of the RRE (retroreflective efficiency) per cone. An interval of +-1.96 standard errors has a
  /// confidence of 95 %. Without PopulationControl, it is 0. With PopulationControl, it is at least the power of one
  /// survivor divided by the number of replicates. This allows for light that no replicate has traced.
  std::vector<double> std_error;
  std::uint64_t beams = 0;
  std::uint32_t depth = 0;  ///< number of interfaces on the longest path
  double cutoff = 0.0;      ///< final cut-off
  bool complete = true;     ///< false if the trace was cancelled or ended early; the ledgers are then invalid
};

/// A beam that leaves the part through the entrance face, or is reflected there from outside.
struct ReturnedBeam {
  Vec3 direction = Vec3::UnitZ();
  Stokes stokes;            ///< Stokes vector of the whole beam; its first axis is source_axis()
  double efficiency = 0.0;  ///< power as a fraction of the light that is incident on the entry region of the beam
  std::uint32_t depth = 0;  ///< number of interfaces inside the part; 0 if the light never entered
  std::size_t cone = 0;     ///< index of the narrowest cone that contains the beam, or the number of cones if none does
  /// Convex polygons on the entrance face through which the beam enters and leaves. They are counter-clockwise and in
  /// the part frame. In an infinite part, `entry_polygon_mm` is located within the central period. If the face reflects
  /// the beam from outside, `entry_polygon_mm` is empty. In this case `exit_polygon_mm` is the whole face of a finite
  /// part, and empty for an infinite part.
  geometry::Polygon entry_polygon_mm;
  geometry::Polygon exit_polygon_mm;
  /// Maps the point of the entrance face where light leaves to the point where it entered. Both points are relative to
  /// the part's centre. The trace of the linear part is 2 for a plane mirror, -2 for a cube corner, and 0 for a prism,
  /// which reverses only one axis.
  Eigen::Affine2d entry_from_exit = Eigen::Affine2d::Identity();
  double index = 1.0;  ///< refractive index of the part
  /// Jones matrix of the field. Its inputs are the amplitudes along the axes of the source. Its outputs are the
  /// amplitudes along source_axis() of `direction`, and along the axis perpendicular to `direction` and source_axis().
  JonesMatrix jones = JonesMatrix::Identity();
  double transmission = 0.0;  ///< power of the beam, as a fraction of the incident power, without the losses in `jones`
  /// Index of the replicate if the beam was resampled (PopulationControl). Results of such beams are averaged over the
  /// replicates. Beams that were traced exactly have no replicate.
  std::optional<std::uint32_t> replicate;
  /// Optical path length that defines the phase of the returned wave at the centre of the entrance face. Let p be a
  /// point of the face relative to the centre, and `to_source` the unit vector towards the source. The incident wave at
  /// p is exp(-2 pi i to_source . p / wavelength). The returned wave at p is `jones` times
  /// exp(2 pi i (phase_mm + direction . p) / wavelength).
  double phase_mm = 0.0;
  geometry::Vec2 centre_mm = geometry::Vec2::Zero();  ///< centre of the entrance face, in the part frame
  CellTrail trail;
  /// Displacements to all identical beams that this beam represents, including the displacement 0. The pointer is null
  /// if the beam represents only itself. All powers of this structure refer to a single beam.
  std::shared_ptr<const InstanceOffsets> instance_offsets;
  /// Facets with texture or form that the beam has met, as functions of a point of the entrance face relative to the
  /// part's centre. The field and the power of the beam do not include the phase shifts of these facets.
  std::vector<TexturedHit> hits;

  double instance_count() const { return instance_offsets ? static_cast<double>(instance_offsets->size()) : 1.0; }
};

/// Function that is called for every returned beam as soon as it is found. If the cut-off is not given, a first trace
/// finds it and a second trace calls the function.
using BeamObserver = std::function<void(const ReturnedBeam&)>;

/// Traces parallel beams of polygonal cross-section from facet to facet. Plane smooth facets split a beam into a finite
/// number of beams, so that no sampling is needed. Power below the cut-off, or lost between polygons by rounding, is
/// added to `truncated`. Weak beams can be resampled instead (BeamPolicy::population_control).
///
/// Facets with a form are treated as planes, and the points where beams meet them are recorded. Coplanar facets of
/// neighbouring cells are joined, so that a recorded point may belong to several facets. It belongs to a single facet
/// if BeamPolicy::separate_cells is true. At textured facets, only the mean field is traced (mean_field(),
/// mean_field_fraction()). The scattered power is added to `truncated`, except with BeamPolicy::keeps_phases. All
/// threads may share one tracer.
class BeamTracer {
 public:
  enum class Elements { individual, instanced };
  /// \param elements `instanced` traces identical beams in identical elements as one beam. The beam is split near a
  /// border of the array, where the paths differ. The observer receives it with ReturnedBeam::instance_offsets.
  /// \pre `part` outlives the tracer
  explicit BeamTracer(const geometry::Part& part, Elements elements = Elements::individual);

  /// Traces the beams above the cut-off. If BeamPolicy::population_control is set, the beams below it are resampled,
  /// and their mean over the replicates is added to the result.
  /// \param progress receives the finished fraction of the expected work; may be null; not used if
  /// BeamPolicy::population_control is set
  /// \throw BudgetError if `max_beams` is reached; the message contains the power that was not accounted for
  BeamResult trace(const Optics& optics, const Illumination& illumination, const std::vector<double>& cones_deg,
                   const BeamPolicy& policy, const Cancellation* cancel = nullptr, const BeamObserver& observer = {},
                   Progress* progress = nullptr) const;

  const geometry::Part& part() const { return part_; }
  /// Centre of the part in the part frame. Coordinates of beams are relative to this point.
  const Vec2& centre_mm() const { return centre_mm_; }

 private:
  BeamResult trace_with_population_control(const Optics& optics, const Illumination& illumination,
                                           const std::vector<double>& cones_deg, const BeamPolicy& policy,
                                           const Cancellation* cancel, const BeamObserver& observer) const;
  /// \pre `setup` and `policy` outlive the scene
  BeamScene scene(const LightSetup& setup, const BeamPolicy& policy) const;

  friend class BeamTrace;
  friend class StochasticBeams;

  const geometry::Part& part_;
  Vec2 centre_mm_;
  CellIndex cells_;
  std::optional<TranslationalSymmetry> symmetry_;
};

/// A trace of a BeamTracer that can be paused, or abandoned if another method is faster. Not thread-safe.
class BeamTrace {
 public:
  /// \pre `tracer` outlives the trace
  BeamTrace(const BeamTracer& tracer, const Optics& optics, const Illumination& illumination,
            const std::vector<double>& cones_deg, const BeamPolicy& policy, BeamObserver observer = {});
  ~BeamTrace();

  /// Continues until the goal is reached or the total work is `max_work`.
  /// \return true if the goal is reached; false if it is not reached or the trace was cancelled
  /// \throw BudgetError in the same cases as BeamTracer::trace()
  bool advance(std::uint64_t max_work, const Cancellation* cancel);
  /// Returns the work done so far; expected_work() returns the estimated total. The unit is one test of a beam against
  /// the bounding box of a facet, about 20 ns. The number does not depend on the machine.
  double work() const;
  double expected_work() const;
  BeamResult result() const;

 private:
  void start();

  const BeamTracer& tracer_;
  const LightSetup setup_;
  BeamPolicy policy_;
  BeamObserver observer_;
  double cutoff_;
  double work_before_ = 0.0;  ///< work of abandoned walks, whose cut-off was too high
  bool is_done_ = false;
  std::unique_ptr<BeamWalk> walk_;
};

}  // namespace retrace::raytrace
