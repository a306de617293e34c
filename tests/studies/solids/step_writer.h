#pragma once

#include <array>
#include <string>
#include <vector>

namespace retrace::test {

/// Box from a lower to an upper corner, mm.
struct Box {
  std::array<double, 3> lower;
  std::array<double, 3> upper;
};

/// Writes boxes as separate solids of one STEP file.
/// \param unit unit of length of the file: "MM" or "M"
void write_boxes(const std::string& file, const std::vector<Box>& boxes, const std::string& unit = "MM");

/// Writes a plate with a rectangular plan and a half cylinder below it, whose axis is parallel to y.
void write_plate_with_half_cylinder(const std::string& file, double side_mm, double thickness_mm, double radius_mm);

/// Writes the surface of a box without its body: a file without a solid.
void write_shell(const std::string& file);

}  // namespace retrace::test
