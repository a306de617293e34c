#pragma once

// The exact engine: follows polygonal beams through a part without sampling, and tells RRE, ledger and every returned
// beam.

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/progress.h"
#include "geometry/part/part.h"
#include "raytrace/exact/beam.h"
#include "raytrace/exact/equal_places.h"
#include "raytrace/faces/cell_index.h"
#include "raytrace/light/light_setup.h"

namespace retrace::raytrace {

class BeamWalk;

/// Power that the exact engine leaves behind where nothing else is asked: far below what anything else is known to.
inline constexpr double kFinestGoal = 1e-10;

/// What becomes of beams below the cut-off where they are not given up: in each replicate they are resampled
/// (BeamGeneration), so that means over replicates have no bias and their spread tells the error.
struct WeakBeams {
  std::uint32_t seed = 1;
  std::uint32_t replicates = 16;  ///< >= 2
  /// A survivor stands for this many times the cut-off, or less: strong beams are followed once and survivors in every
  /// replicate.
  double thinning = 32.0;
};

/// How far beams are followed.
struct BeamPolicy {
  /// Least power of a beam that is followed, of beams at equal elements of a finite part together. Without one it
  /// starts at 1e-6 and falls until less than `truncated_goal` is left behind.
  std::optional<double> cutoff;
  /// Resampling of the beams whose power is below `cutoff`. Without resampling, tracing stops at these beams, and their
  /// power is booked as `truncated`. Only BeamTracer::trace() supports resampling.
  /// \pre `cutoff` is set and all facets are plane; rough facets require `keeps_phases`
  std::optional<WeakBeams> weak;
  double truncated_goal = kFinestGoal;
  /// Work of BeamTrace within which beams are followed below the goal, down to `kFinestGoal`: what costs next to
  /// nothing is not left behind.
  std::uint64_t spare_work = 0;
  std::uint64_t max_beams = 100'000'000;  ///< followed in all, while the cut-off is being found
  /// Facets of neighbouring cells are kept apart even where they lie in one plane, so that every returned beam belongs
  /// to its cell.
  bool by_cell = false;
  /// Textured facets leave beams all their light, and every returned beam tells which of them it has met: what is
  /// specular and what scatters is for the far field to say. For textures with has_phases() alone.
  bool keeps_phases = false;
};

struct BeamResult {
  std::vector<Ledger> ledgers;  ///< by cone, in the order given
  std::vector<Stokes> stokes;   ///< of what is retroreflected, by cone, along source_axis()
  /// Of RRE, by cone: 1.96 of them hold the truth in 95 of 100 cases. 0 without WeakBeams. Never less than what a
  /// survivor brings over the number of replicates, as so much may be in beams that none of them has seen.
  std::vector<double> std_error;
  std::uint64_t beams = 0;
  std::uint32_t depth = 0;  ///< interfaces on the longest path
  double cutoff = 0.0;      ///< that was used in the end
  bool complete = true;     ///< false if it was cancelled or not taken to its end; the ledgers are then of no use
};

/// A beam that leaves the part through the entrance face, or is reflected there from outside.
struct ReturnedBeam {
  Vec3 direction = Vec3::UnitZ();
  Stokes stokes;            ///< of the whole beam, along source_axis()
  double efficiency = 0.0;  ///< its power as a share of what fell on the region where it entered
  std::uint32_t depth = 0;  ///< interfaces inside; 0: never entered
  std::size_t cone = 0;     ///< the narrowest cone that holds it; their number if none does
  /// Convex polygons on the entrance face through which the beam enters and leaves, counter-clockwise, in the part
  /// frame. In an infinite part, `entered_mm` is located within the central period. If the face reflects the beam from
  /// outside, `entered_mm` is empty. In this case `left_mm` is the whole face of a finite part, and empty for an
  /// infinite part.
  geometry::Polygon entered_mm;
  geometry::Polygon left_mm;
  /// Maps the exit point of light on the entrance face to its entry point. Both points are relative to the part's
  /// centre. The trace of the linear part is 2 for a plane mirror, -2 for a cube corner, and 0 for a prism, which
  /// reverses only one axis.
  Eigen::Affine2d entry_from_exit = Eigen::Affine2d::Identity();
  double index = 1.0;  ///< refractive index of the part
  /// Of the field: along source_axis() and the axis across it, of its own direction, for unit amplitudes along those
  /// of the source.
  JonesMatrix jones = JonesMatrix::Identity();
  double transmission = 0.0;  ///< share of the incident power that a matrix of unit gain would bring here
  /// Of WeakBeams: the mean over replicates counts. None of a beam that was followed exactly.
  std::optional<std::uint32_t> replicate;
  /// Optical path length that gives the phase of the returned wave at the centre of the entrance face. Let p be a point
  /// of the face relative to the centre and `to_source` the unit vector towards the source. The incident wave at p is
  /// exp(-2 pi i to_source . p / wavelength). The returned wave at p is `jones` times
  /// exp(2 pi i (phase_mm + direction . p) / wavelength).
  double phase_mm = 0.0;
  geometry::Vec2 centre_mm = geometry::Vec2::Zero();  ///< centre of the entrance face, in the part frame
  CellTrail trail;
  /// Offsets of the beams like it that this one stands for, itself included; null: for itself alone. Powers are those
  /// of one.
  std::shared_ptr<const BeamPlaces> places;
  /// Of places on the entrance face, relative to the part's centre. The field and its power are those before the phases
  /// of these facets.
  std::vector<TexturedHit> hits;

  double place_count() const { return places ? static_cast<double>(places->size()) : 1.0; }
};

/// Called for every returned beam, as it is found. With a cut-off that has to be found first, that takes a run of its
/// own.
using BeamObserver = std::function<void(const ReturnedBeam&)>;

/// Follows parallel beams of polygonal cross-section from facet to facet: plane smooth facets turn one beam into
/// finitely many, so nothing is sampled. Of facets with a form it follows the planes, and tells where they were met;
/// with BeamPolicy::by_cell alone these are those of single facets. What is cut off or falls between polygons by
/// rounding is booked in `truncated`, unless BeamPolicy::weak has weak beams resampled. Of textured facets it follows
/// the mean field alone (mean_field(), mean_field_share()): what scatters is booked there as well, unless
/// BeamPolicy::keeps_phases. A value shared by all threads.
class BeamTracer {
 public:
  enum class Elements { each_by_itself, equal_at_once };
  /// \param elements The value `equal_at_once` traces identical beams in identical elements as one beam, until their
  ///        paths differ near a border of the array. The observer receives one beam with ReturnedBeam::places.
  /// \pre `part` outlives the tracer
  explicit BeamTracer(const geometry::Part& part, Elements elements = Elements::each_by_itself);

  /// Traces beams above the cut-off. If BeamPolicy::weak is set, weak beams are resampled and contribute the mean over
  /// the replicates.
  /// \param progress receives the finished fraction of the expected work; null, or with BeamPolicy::weak: nothing is
  ///        reported
  /// \throw BudgetError if `max_beams` is reached; the message contains the power that was accounted for
  BeamResult trace(const Optics& optics, const Illumination& illumination, const std::vector<double>& cones_deg,
                   const BeamPolicy& policy, const Cancellation* cancel = nullptr, const BeamObserver& observer = {},
                   Progress* progress = nullptr) const;

  const geometry::Part& part() const { return part_; }
  /// Of the part: beams are relative to it.
  const Vec2& centre_mm() const { return centre_mm_; }

 private:
  BeamResult trace_with_weak(const Optics& optics, const Illumination& illumination,
                             const std::vector<double>& cones_deg, const BeamPolicy& policy, const Cancellation* cancel,
                             const BeamObserver& observer) const;
  const EqualPlaces* equal_places() const { return equal_ ? &*equal_ : nullptr; }

  friend class BeamTrace;
  friend class StochasticBeams;

  const geometry::Part& part_;
  Vec2 centre_mm_;
  CellIndex cells_;
  std::optional<EqualPlaces> equal_;
};

/// One trace of a BeamTracer that can be paused: to be dropped if something else is quicker. For one thread at a time.
class BeamTrace {
 public:
  /// \pre `tracer` outlives the trace
  BeamTrace(const BeamTracer& tracer, const Optics& optics, const Illumination& illumination,
            const std::vector<double>& cones_deg, const BeamPolicy& policy, BeamObserver observer = {});
  ~BeamTrace();

  /// Goes on until the goal is reached or `most_work` is done in all. \return true when the goal is reached; false as
  /// well if it was cancelled \throw BudgetError as BeamTracer::trace()
  bool advance(std::uint64_t most_work, const Cancellation* cancel);
  /// Done so far and expected in all, in looks at a facet's bounding box: some 20 ns each, and the same number on every
  /// machine.
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
  double work_before_ = 0.0;  ///< of walks whose cut-off was too high
  bool is_done_ = false;
  std::unique_ptr<BeamWalk> walk_;
};

}  // namespace retrace::raytrace
