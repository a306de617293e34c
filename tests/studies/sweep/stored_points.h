#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <filesystem>
#include <map>
#include <string>

#include "tests/app/program.h"

namespace retrace::test {

/// Returns a study whose points take a few milliseconds each.
inline std::string sweep_study(int points, int samples = 8000) {
  return "schema = \"retrace.study/1\"\ndesign = \"" + example("honeycomb_infinite.toml") +
         "\"\n[[parameter]]\nkey = \"analysis.incidence_deg\"\nfrom = 0\nto = 40\ncount = " + std::to_string(points) +
         "\n[[quantity]]\nkind = \"rre\"\n[analysis]\nengine = \"cell\"\nsamples = " + std::to_string(samples) + "\n";
}

/// Returns the computing time of each point in a store, by the number of the point. A running command may be using the
/// store.
inline std::map<int, double> stored_points(const std::filesystem::path& file) {
  std::map<int, double> points;
  try {
    SQLite::Database database(file.string(), SQLite::OPEN_READONLY, 10000);
    SQLite::Statement query(database, "SELECT point, elapsed_s FROM points");
    while (query.executeStep()) points[query.getColumn(0).getInt()] = query.getColumn(1).getDouble();
  } catch (const SQLite::Exception&) {
    return {};  // the store does not exist yet
  }
  return points;
}

}  // namespace retrace::test
