#pragma once

#include "fabrication/verify/error_field.h"
#include "studies/closed_loop/verification.h"

namespace retrace::studies {

/// What the programs leave against the design, for a picture.
struct ErrorMap {
  fabrication::ErrorField field;
  double shown_nm = 0.0;  ///< heights beyond +- this are drawn as this
};

ErrorMap error_map(const VerificationRun& run);

}  // namespace retrace::studies
