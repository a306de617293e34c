#include "fabrication/post/dialects.h"

#include <array>

namespace retrace::fabrication {
namespace {

/// RS274/NGC as LinuxCNC's interpreter reads it (T. Kramer et al., NISTIR 6556, 2000; LinuxCNC's o-word subroutines).
constexpr DialectWords kRs274ngc = {.dialect = {"rs274ngc", ".ngc", "RS274/NGC as LinuxCNC reads it: the reference"},
                                    .subroutines_first = true,
                                    .file_ends = "%\n",
                                    .main_begin = "",
                                    .main_end = "M2\n",
                                    .prepare = "G17 G21 G40 G49 G80 G90 G94\nG54 G61 G92.1\nM5\n",
                                    .spindle_start = "G97 S{0} {1}\n",  // S is no cutting speed
                                    .spindle_stop = "M5\n",
                                    .comment = "({})\n",
                                    .message = "(MSG, {})\n",
                                    .subroutine_begin = "({1})\no{0} sub\nG91\n",
                                    .subroutine_end = "G90\no{0} endsub\n",
                                    .call = "o{} call\n",
                                    .rapid = "G0",
                                    .linear = "G1",
                                    .dwell = "G4 P{0:.3f}\n",
                                    .path_begin = "G64\nG93\n",
                                    .path_time = " F{0:.6f}",
                                    .path_end = "G94\nG61\n"};

/// Siemens Sinumerik 840D (programming manuals Fundamentals and Job Planning). Routines are sections of the main
/// program behind its end, called by CALL BLOCK, so that one file runs alone.
constexpr DialectWords kSinumerik = {.dialect = {"sinumerik", ".mpf", "Siemens Sinumerik 840D"},
                                     .subroutines_first = false,
                                     .file_ends = "",
                                     .main_begin = "",
                                     .main_end = "M30\n",
                                     .prepare = "TRAFOOF\nTRANS\nG17 G710 G40 G90 G94\nG54 G60 D0\nM5\n",
                                     .spindle_start = "S{0} {1}\n",
                                     .spindle_stop = "M5\n",
                                     .comment = "; {}\n",
                                     .message = "MSG(\"{}\")\n",
                                     .subroutine_begin = "; {1}\nRT{0}:\nG91\n",
                                     .subroutine_end = "G90\nRE{0}:\n",
                                     .call = "CALL BLOCK RT{0} TO RE{0}\n",
                                     .rapid = "G0",
                                     .linear = "G1",
                                     .dwell = "G4 F{0:.3f}\n",
                                     .path_begin = "G64\nG93\n",
                                     .path_time = " F{0:.6f}",
                                     .path_end = "G94\nG60\n"};

/// Fanuc 30i (operator's manual B-63944). Six decimals ask for increment system IS-E or a setting as fine. Messages are
/// comments: #3006 would stop the machine. Program numbers have four digits.
constexpr DialectWords kFanuc = {.dialect = {"fanuc", ".nc", "Fanuc, 30i series"},
                                 .subroutines_first = false,
                                 .file_ends = "%\n",
                                 .main_begin = "O0001\n",
                                 .main_end = "M30\n",
                                 .prepare = "G17 G21 G40 G49 G80 G90 G94\nG54 G61 G69\nM5\n",
                                 .spindle_start = "G97 S{0} {1}\n",
                                 .spindle_stop = "M5\n",
                                 .comment = "({})\n",
                                 .message = "({})\n",
                                 .subroutine_begin = "O{0:04}\n({1})\nG91\n",
                                 .subroutine_end = "G90\nM99\n",
                                 .call = "M98 P{:04}\n",
                                 .rapid = "G0",
                                 .linear = "G1",
                                 .dwell = "G4 P{1}\n",
                                 .path_begin = "G64\nG93\n",
                                 .path_time = " F{0:.6f}",
                                 .path_end = "G94\nG61\n"};

/// Power PMAC script (Power PMAC user's and software reference manuals): no G codes, an explicit prelude, dwells in ms.
/// Coordinate system 1 is to have the axes X, Y, Z in mm and A, C in degrees. M codes are subprograms of the
/// integrator's, and one that is missing is skipped without a word: what starts and stops a spindle is told from
/// outside.
constexpr DialectWords kPmac = {
    .dialect = {"pmac", ".pmc", "Omron (Delta Tau) Power PMAC"},
    .subroutines_first = true,
    .file_ends = "",
    .main_begin = "open prog 1\n",
    .main_end = "close\n",
    .prepare = "Coord[1].FeedTime=60000\nCoord[1].NoBlend=1\nCoord[1].SegMoveTime=0\nfrax(X,Y,Z)\nccmode0\nabs\nM5\n",
    .spindle_start = "{2}\n",
    .spindle_stop = "{}\n",
    .comment = "// {}\n",
    .message = "// {}\n",
    .subroutine_begin = "// {1}\nopen subprog {0}\ninc\n",
    .subroutine_end = "abs\nclose\n",
    .call = "call {}\n",
    .rapid = "rapid",
    .linear = "linear",
    .dwell = "dwell {1}\n",
    .path_begin = "Coord[1].NoBlend=0\nta0 ts0\n",
    .path_time = " tm{1:.6f}",
    .path_end = "Coord[1].NoBlend=1\n"};

constexpr std::array kDialects = {kRs274ngc, kSinumerik, kFanuc, kPmac};

}  // namespace

std::span<const DialectWords> dialect_words() {
  return kDialects;
}

}  // namespace retrace::fabrication
