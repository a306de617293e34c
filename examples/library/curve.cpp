// Retroreflective efficiency of a design against angle: curve DESIGN.toml

#include <iostream>

#include "retrace/rre.h"

int main(int, char** argv) try {
  const retrace::RreResult result = retrace::rre(retrace::Design::load(argv[1]), {.incidence_deg = {0, 10, 20, 30}});
  for (const auto& point : result.points) std::cout << point.incidence_deg << " deg: " << point.rre << '\n';
} catch (const retrace::Error& error) {
  std::cerr << error.what() << '\n';
  return static_cast<int>(error.exit_code());
}
