#pragma once

// Sizes of prisms for which a whole number of elements fills the part. Internal to studies/optimise.

#include <vector>

#include "design/design.h"
#include "studies/quantity/study.h"

namespace retrace::studies {

/// Element sizes for which a whole number of elements fills the length of a part. The size is a parameter of a study.
class WholeSizes {
 public:
  WholeSizes() = default;
  /// Determines the lengths that elements of this size fill: along x for `element.base_mm`, along y for
  /// `element.width_mm`. There are no such lengths for infinite arrays, for elements other than prisms, and for parts
  /// on a substrate.
  WholeSizes(const design::Design& design, const Parameter& parameter);

  bool is_empty() const { return lengths_.empty(); }
  /// Returns true if a whole number of elements of this size fills all lengths of the part.
  bool is_whole(double size_mm) const;
  /// Returns the sizes from `low_mm` to `high_mm` with which whole numbers of elements fill all lengths. If there are
  /// no such sizes, returns the sizes that fill only one of the lengths.
  std::vector<double> between(double low_mm, double high_mm) const;

 private:
  /// Length that elements and the gaps between them fill.
  struct Length {
    double room_mm = 0.0;  ///< total length of the elements, each with one gap
    double gap_mm = 0.0;
  };
  static bool divides(const Length& length, double size_mm);

  std::vector<Length> lengths_;
};

/// Returns values near `value` with few digits: multiples of 1, 2 and 5 times powers of ten. Values with fewer digits
/// come first. Among equally round values, sizes for which a whole number of elements fills the part come first.
/// \param low minimum of the values
/// \param high maximum of the values
std::vector<double> round_values(double value, double low, double high, const WholeSizes& whole);

}  // namespace retrace::studies
