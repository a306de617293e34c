#pragma once

// Retroreflective efficiency of a design over the roughness and waviness of its facets. The study behind `retrace
// roughness`.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/shared_tasks.h"
#include "studies/design/design.h"
#include "studies/rre/rre.h"

namespace retrace::studies {

/// Measured facets of one process, or one facet, by their means.
struct FacetGroup {
  std::string table;  ///< file that holds them
  int line = 0;       ///< of the first
  std::string name;
  bool is_process = false;  ///< else it is one facet
  std::size_t facets = 0;
  double roughness_sa_nm = 0.0;  ///< mean Sa below the cut-off of the measurement
  double waviness_sa_nm = 0.0;   ///< mean Sa above it
};

/// What is asked: RRE of one design against the roughness of its facets.
struct RoughnessRequest {
  std::vector<double> sa_nm;                  ///< of the curves, each >= 0
  std::vector<double> correlation_length_um;  ///< one curve each, > 0; the first is that of the measured facets
  double waviness_length_um = 200.0;          ///< period of the measured facets' waviness, > 0
  std::vector<FacetGroup> measured;
  double incidence_deg = 0.0;
  double azimuth_deg = 0.0;
  std::optional<std::uint64_t> rays;  ///< per point; else until target_error is reached
  double target_error = 1e-3;         ///< standard error of RRE as a fraction
  std::uint32_t seed = 1;
};

struct RoughnessPoint {
  double roughness_sa_nm = 0.0;
  double waviness_sa_nm = 0.0;
  double correlation_length_um = 0.0;
  std::optional<std::size_t> measured;  ///< which of the request's groups; a point of a curve otherwise
  double rre = 0.0;
  double std_error = 0.0;
};

struct RoughnessResult {
  Design design;
  RoughnessRequest request;
  double smooth_rre = 0.0;  ///< of smooth facets, by the exact engine where it is cheap
  double smooth_std_error = 0.0;
  std::vector<RoughnessPoint> points;  ///< curves in the order of the request, then the measured facets
  std::uint64_t rays = 0;
  double elapsed_s = 0.0;
  std::vector<std::string> warnings;
  bool complete = true;
};

/// Gaussian heights of this Sa have this rms height.
double gaussian_sq_nm(double sa_nm);

/// A checked request, ready to run.
class RoughnessStudy {
 public:
  /// \throw InputError for a design with a texture of its own or several acceptance angles, for numbers out of range
  /// and for facets that no model of scatter holds for
  RoughnessStudy(Design design, RoughnessRequest request);
  ~RoughnessStudy();

  /// \param share has the points traced by several processes, each with an equal study; none: by this one
  /// \throw BudgetError if power was lost
  RoughnessResult run(Progress* progress = nullptr, const Cancellation* cancel = nullptr,
                      const ShareTasks& share = {}) const;
  /// A point that is traced, as a task of its number. \throw BudgetError likewise
  std::optional<std::string> compute_shared(std::uint64_t number, const Cancellation* cancel) const;

 private:
  struct Prepared;
  RreResult trace_shared(Progress* progress, const ShareTasks& share) const;

  std::unique_ptr<Prepared> prepared_;
};

}  // namespace retrace::studies
