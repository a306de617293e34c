#pragma once

// STEP files for tests. They are written by the Python module examples/lamp/write_step.py, without OpenCASCADE.

#include <gtest/gtest.h>

#include <string>

#include "tests/app/program.h"

namespace retrace::testing {

/// Runs Python code that uses the module `w`, which writes STEP files, in a folder.
inline void run_step_writer(const test::TemporaryFolder& folder, const std::string& code) {
  const std::string setup = "import sys; sys.dont_write_bytecode = True; sys.path.insert(0, '" RETRACE_SOURCE_DIR
                            "/examples/lamp'); import write_step as w\n";
  const test::Outcome outcome = test::Child(folder.path(), {RETRACE_PYTHON, "-c", setup + code}).wait();
  ASSERT_EQ(outcome.code, 0) << outcome.err;
}

/// Writes a STEP file.
/// \param name name of the file
/// \param statement Python statement that adds faces to the file `s`, such as "w.sphere(s)"
inline void write_step(const test::TemporaryFolder& folder, const std::string& name, const std::string& statement,
                       const std::string& unit = "mm", bool is_solid = false) {
  run_step_writer(folder, "s = w.StepFile('" + unit + "')\n" + statement + "\nopen('" + name + "', 'w').write(s.text(" +
                              (is_solid ? "True" : "False") + "))\n");
}

}  // namespace retrace::testing
