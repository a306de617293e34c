#pragma once

// G codes that RS274/NGC and Fanuc controls have in common.

#include <array>

#include "fabrication/read/nc_text.h"

namespace retrace::fabrication {

/// G codes with the same modal group and the same effect in NISTIR 6556, table 4, and in Fanuc's operator's manual.
inline constexpr std::array kCommonIsoCodes = {NcCode{0, 1, nc_effects::kRapid},
                                               NcCode{1, 1, nc_effects::kLinear},
                                               NcCode{17, 2, nc_effects::kNone},
                                               NcCode{18, 2, nc_effects::kNone},
                                               NcCode{19, 2, nc_effects::kNone},
                                               NcCode{20, 6, nc_effects::kInch},
                                               NcCode{21, 6, nc_effects::kMillimetre},
                                               NcCode{40, 7, nc_effects::kMarks<nc_setting::kRadiusOff>},
                                               NcCode{49, 8, nc_effects::kMarks<nc_setting::kLengthOff>},
                                               NcCode{90, 3, nc_effects::kAbsolute},
                                               NcCode{91, 3, nc_effects::kIncremental},
                                               NcCode{93, 5, nc_effects::kInverseTime}};

}  // namespace retrace::fabrication
