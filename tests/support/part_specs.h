#pragma once

#include <string>

#include "geometry/elements/part_spec.h"

// Specifications of finite and infinite parts for tests.

namespace retrace::testing {

/// Part of a test case, and its name in messages.
struct NamedPart {
  std::string name;
  geometry::PartSpec spec;
};

inline geometry::PartSpec finite(geometry::Element element, geometry::Arrangement arrangement, double x_mm, double y_mm,
                                 double thickness_mm) {
  geometry::PartSpec spec;
  spec.element = element;
  spec.array.arrangement = arrangement;
  spec.array.x_length_mm = x_mm;
  spec.array.y_length_mm = y_mm;
  spec.thickness_mm = thickness_mm;
  return spec;
}

inline geometry::PartSpec infinite(geometry::Element element, geometry::Arrangement arrangement, double thickness_mm) {
  geometry::PartSpec spec;
  spec.element = element;
  spec.array.arrangement = arrangement;
  spec.array.extent = geometry::Extent::infinite;
  spec.thickness_mm = thickness_mm;
  return spec;
}

inline geometry::PartSpec single(geometry::Element element, double thickness_mm) {
  geometry::PartSpec spec;
  spec.element = element;
  spec.array.arrangement = geometry::Arrangement::single;
  spec.thickness_mm = thickness_mm;
  return spec;
}

}  // namespace retrace::testing
