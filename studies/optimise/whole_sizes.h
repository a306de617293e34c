#pragma once

// Sizes of prisms with which a whole number of elements fills the part. Internal to studies/optimise.

#include <vector>

#include "design/design.h"
#include "studies/quantity/study.h"

namespace retrace::studies {

/// Element sizes with which a whole number of elements fills a length of the part. The size is a parameter of a study.
class WholeSizes {
 public:
  WholeSizes() = default;
  /// Determines the lengths that elements fill: the length along x for `element.base_mm`, the length along y for
  /// `element.width_mm`. Infinite arrays, elements other than prisms, and parts on a substrate have no such lengths.
  WholeSizes(const design::Design& design, const Parameter& parameter);

  bool is_empty() const { return lengths_.empty(); }
  /// Returns true if a whole number of elements of the given size fills each length of the part.
  bool is_whole(double size_mm) const;
  /// Returns the sizes from `low_mm` to `high_mm` with which whole numbers of elements fill all lengths. If no size
  /// fills all lengths, returns the sizes that fill one length.
  std::vector<double> between(double low_mm, double high_mm) const;

 private:
  /// Length of the part that elements and the gaps between them fill.
  struct Length {
    double room_mm = 0.0;  ///< total length of all elements, where each element includes one gap
    double gap_mm = 0.0;
  };
  static bool divides(const Length& length, double size_mm);

  std::vector<Length> lengths_;
};

/// Returns values near `value` with few digits, which are multiples of 1, 2 or 5 times a power of ten. Values with
/// fewer digits come first. Of two values with equally many digits, the value with which a whole number of elements
/// fills the part comes first.
/// \param low smallest allowed value
/// \param high largest allowed value
std::vector<double> round_values(double value, double low, double high, const WholeSizes& whole);

}  // namespace retrace::studies
