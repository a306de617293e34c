#pragma once

// Retroreflective efficiency of a design as a function of the roughness and waviness of its facets. `retrace roughness`
// runs this study.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/shared_tasks.h"
#include "core/warning.h"
#include "design/design.h"
#include "requests/roughness.h"
#include "studies/rre/rre.h"

namespace retrace::studies {

/// Mean values of the measured facets of one process, or values of a single facet.
struct FacetGroup {
  std::string table;  ///< name of the file
  int line = 0;       ///< line of the first facet
  std::string name;
  bool is_process = false;  ///< true: a process; false: a single facet
  std::size_t facets = 0;
  double roughness_sa_nm = 0.0;  ///< mean Sa of the heights with wavelengths below the cut-off of the measurement
  double waviness_sa_nm = 0.0;   ///< mean Sa of the heights with wavelengths above the cut-off of the measurement
};

struct RoughnessPoint {
  double roughness_sa_nm = 0.0;
  double waviness_sa_nm = 0.0;
  double correlation_length_um = 0.0;
  std::optional<std::size_t> measured;  ///< index of the group of measured facets; none: the point belongs to a curve
  double rre = 0.0;
  double std_error = 0.0;
};

struct RoughnessResult {
  design::Design design;
  RoughnessRequest request;
  std::vector<FacetGroup> measured;
  double smooth_rre = 0.0;  ///< RRE for smooth facets, from the exact engine if this is fast
  double smooth_std_error = 0.0;
  std::vector<RoughnessPoint> points;  ///< curves in the order of the request, then the measured facets
  std::uint64_t rays = 0;
  double elapsed_s = 0.0;
  Warnings warnings;
  bool complete = true;
};

/// Returns the rms height of a Gaussian height distribution with the given Sa.
double gaussian_sq_nm(double sa_nm);

/// Roughness study of a design. The constructor checks the request, and run() computes the points.
class RoughnessStudy {
 public:
  /// \param measured measured facets, each of which is a further point
  /// \throw InputError for a design with its own texture or several acceptance angles, for numbers out of range, and
  /// for facets for which no scatter model is valid
  RoughnessStudy(design::Design design, RoughnessRequest request, std::vector<FacetGroup> measured = {});
  ~RoughnessStudy();

  /// Computes all points.
  /// \param distribute function that distributes the points among several processes with equal studies. Without it,
  ///        this process traces all points.
  /// \throw BudgetError if power is lost because a ray inside the part missed every face, or if a budget is exhausted
  RoughnessResult run(Progress* progress = nullptr, const Cancellation* cancel = nullptr,
                      const DistributeTasks& distribute = {}) const;
  /// Traces the point with this number, as a task of a computation that several processes share.
  /// \throw BudgetError if power is lost because a ray inside the part missed every face, or if a budget is exhausted
  std::optional<std::string> compute_shared(std::uint64_t number, const Cancellation* cancel) const;

 private:
  struct Prepared;
  RreResult trace_shared(Progress* progress, const DistributeTasks& distribute) const;

  std::unique_ptr<Prepared> prepared_;
};

}  // namespace retrace::studies
