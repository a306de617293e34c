#pragma once

#include <string>

#include "app/command.h"

namespace retrace::app {

// Arguments that several commands have.

Argument design_argument(std::string& design);
Argument job_argument(std::string& job, const std::string& help = "job file");
Argument part_argument(std::string& part);
Argument dialect_argument(std::string& dialect);
/// Of commands whose engines are auto, exact, montecarlo and embree.
Argument engine_argument(std::string& engine, const std::string& help);
/// none, a shipped dye, or a file.
template <class Name>
Argument dye_argument(Name& dye, const std::string& help) {
  return {"--dye NAME|FILE", help, &dye, one_of(Words{"none", "red", "amber"}, ".csv")};
}

/// Names of engines: all those between the first and the last of studies::Engine, or without `cell`.
Words engine_words(bool with_cell);

}  // namespace retrace::app
