#include "fabrication/post/dialects.h"

#include <array>

namespace retrace::fabrication {
namespace {

/// RS274/NGC as the interpreter of LinuxCNC reads it (T. Kramer et al., NISTIR 6556, 2000; o-word subroutines of
/// LinuxCNC).
constexpr DialectFormats kRs274ngc = {
    .dialect = {"rs274ngc", ".ngc", "RS274/NGC as LinuxCNC reads it: the reference"},
    .subroutines_first = true,
    .file_ends = "%\n",
    .main_begin = "",
    .main_end = "M2\n",
    .needs =
        "Needs: G54 without rotation (R of G10 L2), axes without kinematics of the control,\n"
        "X as a radius (G8), axes A to C in degrees without wrapping",
    .prepare = "G17 G21 G40 G49 G80 G90 G94\nG54 G61.1 G92.1\nM5\n",
    .spindle_start = "G97 S{0} {1}\n",  // G97: S is a rotational speed, not a cutting speed
    .spindle_stop = "M5\n",
    .comment = "({})\n",
    .message = "(MSG, {})\n",
    .subroutine_begin = "({1})\no{0} sub\nG91\n",
    .subroutine_end = "G90\no{0} endsub\n",
    .call = "o{} call\n",
    .rapid = "G0",
    .linear = "G1",
    .dwell = "G4 P{0:.3f}\n",
    // Without Q, the control would merge blocks within the tolerance P.
    .path_begin = "G64 P{0:.6f} Q0.000000\nG93\n",
    .path_time = " F{0:.6f}",
    .path_end = "G94\nG61.1\n"};

/// Siemens Sinumerik 840D (programming manuals Fundamentals and Job Planning). Subroutines are sections after the end
/// of the main program and are executed by REPEAT, so that the file is self-contained. The sign of an absolute position
/// of a modulo axis determines the direction of rotation, unless DC requests the shortest path (MD30455). Negative
/// positions cause alarm 16830.
constexpr DialectFormats kSinumerik = {
    .dialect = {"sinumerik", ".mpf", "Siemens Sinumerik 840D"},
    .subroutines_first = false,
    .file_ends = "",
    .main_begin = "",
    .main_end = "M30\n",
    .needs =
        "Needs: DRF, the basic frame and G500 at zero, for they stay under G54,\n"
        "X as a radius (DIAMOF), rotary axes as modulo axes where words are DC or IC",
    .prepare = "TRAFOOF\nTRANS\nG17 G710 G40 G90 G94\nG54 G60 G601 D0\nM5\n",
    .spindle_start = "S{0} {1}\n",
    .spindle_stop = "M5\n",
    .comment = "; {}\n",
    .message = "MSG(\"{}\")\n",
    .subroutine_begin = "; {1}\nRT{0}:\nG91\n",
    .subroutine_end = "G90\nRE{0}:\n",
    .call = "REPEAT RT{0} RE{0}\n",
    .rapid = "G0",
    .linear = "G1",
    .dwell = "G4 F{0:.3f}\n",
    .path_begin = "G64\nG93\n",
    .path_time = " F{0:.6f}",
    .path_end = "G94\nG60\n",
    .shortest = " {0}=DC({1})",
    .increment = " {0}=IC({1})"};

/// Fanuc 30i (operator's manual B-63944). The machine file determines the number of decimals. Messages are written as
/// comments, because #3006 would stop the machine. Program numbers have four digits. In a path, C may exceed the range
/// of positions. Paths therefore contain increments. The increments are differences of rounded positions and do not
/// drift.
constexpr DialectFormats kFanuc = {
    .dialect = {"fanuc", ".nc", "Fanuc, 30i series"},
    .subroutines_first = false,
    .file_ends = "%\n",
    .main_begin = "O0001\n",
    .main_end = "M30\n",
    .needs =
        "Needs: increment system IS-{1}, X as a radius (1006#3), the external work zero "
        "offset at zero,\nrotary axes without roll-over (1008#0 at 0), or with roll-over "
        "along the shortest path (1008#1 at 0)",
    .prepare = "G17 G21 G40 G49 G80 G90 G94\nG54 G61{2}\nM5\n",
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
    .path_begin = "G64\nG93\nG91\n",
    .path_time = " F{0:.6f}",
    .path_end = "G90\nG94\nG61\n",
    .has_increment_systems = true,
    .has_incremental_paths = true};

/// Power PMAC script (Power PMAC user's and software reference manuals): no G codes, explicit settings at the
/// beginning, dwells in ms. M codes are subprograms of the machine builder, and the control ignores missing ones
/// silently. The machine file must therefore define the lines for spindle and mist.
constexpr DialectFormats kPmac = {
    .dialect = {"pmac", ".pmc", "Omron (Delta Tau) Power PMAC"},
    .subroutines_first = true,
    .file_ends = "",
    .main_begin = "open prog 1\n",
    .main_end = "close\n",
    .needs = "Needs: coordinate system {0} with X, Y, Z in mm and A, B, C in degrees, the spindle stopped",
    .prepare = "Coord[{0}].FeedTime=60000\nCoord[{0}].NoBlend=1\nCoord[{0}].SegMoveTime=0\nfrax(X,Y,Z)\nccmode0\nabs\n",
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
    .path_begin = "Coord[{1}].NoBlend=0\nta0 ts0\n",
    .path_time = " tm{1:.6f}",
    .path_end = "Coord[{0}].NoBlend=1\n",
    .cubic_begin = "Coord[{0}].NoBlend=0\n",
    .cubic_end = "Coord[{0}].NoBlend=1\n",
    .cubic_word = " {}{}:{}",
    .cubic_move = "pvt{4}{0}\n",
    .cubic_time_s = 60.0,
    .mist_on = "{0}\n",
    .mist_off = "{0}\n",
    .optional_stop = "{0}\n",
    .stop = "{0}\n",
    .has_own_texts = true};

/// Aerotech A3200 with its CNC option: G codes and AeroBasic (sources in docs/nc_dialects.md). Blending keeps the speed
/// between lines without leaving the path. A feed is the speed of all axes together, and so determines the duration of
/// a line. The machine builder defines the codes for coolant and spindle.
constexpr DialectFormats kA3200 = {
    .dialect = {"a3200", ".pgm", "Aerotech A3200"},
    .subroutines_first = false,
    .file_ends = "",
    .main_begin = "",
    .main_end = "END PROGRAM\n",
    .needs =
        "Needs: the CNC option, all axes dominant, rotary axes in degrees without rollover,\n"
        "no G98, no rounding of corners, coordinates neither turned nor mirrored,\n"
        "the zero of the workpiece set, the spindle stopped",
    .prepare = "G71 G75 G90 G94 G109\nG40 G149\nWAIT MODE INPOS\n",
    .spindle_start = "{2}\n",
    .spindle_stop = "{}\n",
    .comment = "' {}\n",
    .message = "' {}\n",
    .subroutine_begin = "' {1}\nDFS RT{0}\nG91\n",
    .subroutine_end = "G90\nENDDFS\n",
    .call = "CALL RT{}\n",
    .rapid = "G0",
    .linear = "G1",
    .dwell = "G4 P{0:.3f}\n",
    .path_begin = "G108\n",
    .path_time = " F{2:.6f}",
    .path_end = "G109\n",
    // G76 sets the time unit to seconds, so that times and velocities do not depend on other settings of the control.
    .cubic_begin = "G108\nG76\nPVT INIT TIME ABS\n",
    .cubic_end = "G75\nG109\n",
    .cubic_word = " {} {},{}",
    .cubic_move = "PVT{0} TIME {6}\n",
    .mist_on = "{0}\n",
    .mist_off = "{0}\n",
    .optional_stop = "{0}\n",
    .stop = "{0}\n",
    .has_own_texts = true,
    .has_paths_by_speed = true};

/// Aerotech Automation1: AeroScript with published G codes (help.aerotech.com/automation1), and with functions where no
/// G code is published. Feeds have the same meaning as on the A3200.
constexpr DialectFormats kAutomation1 = {
    .dialect = {"automation1", ".ascript", "Aerotech Automation1"},
    .subroutines_first = false,
    .file_ends = "",
    .main_begin = "program\n",
    .main_end = "end\n",
    .needs =
        "Needs: primary units of mm and degrees, all axes dominant, rotary axes without rollover,\n"
        "no G98, no transformations, the zero of the workpiece set, the spindle stopped",
    .prepare =
        "SetupTaskDistanceUnits(DistanceUnits.Primary)\nSetupTaskTimeUnits(TimeUnits.Minutes)\n"
        "SetupTaskTargetMode(TargetMode.Absolute)\nSetupTaskWaitMode(WaitMode.InPosition)\n"
        "VelocityBlendingOff()\nCornerRoundingOff()\nG94\nG40 G149\n",
    .spindle_start = "{2}\n",
    .spindle_stop = "{}\n",
    .comment = "// {}\n",
    .message = "// {}\n",
    .subroutine_begin = "// {1}\nfunction RT{0}()\nG91\n",
    .subroutine_end = "G90\nend\n",
    .call = "RT{}()\n",
    .rapid = "G0",
    .linear = "G1",
    .dwell = "Dwell({0:.3f})\n",
    .path_begin = "VelocityBlendingOn()\n",
    .path_time = " F{2:.6f}",
    .path_end = "VelocityBlendingOff()\n",
    .cubic_begin = "VelocityBlendingOn()\nSetupTaskTimeUnits(TimeUnits.Seconds)\n",
    .cubic_end = "SetupTaskTimeUnits(TimeUnits.Minutes)\nVelocityBlendingOff()\n",
    .cubic_move = "MovePvt([{1}], [{2}], [{3}], {5})\n",
    .mist_on = "{0}\n",
    .mist_off = "{0}\n",
    .optional_stop = "{0}\n",
    .stop = "{0}\n",
    .has_own_texts = true,
    .has_paths_by_speed = true};

constexpr std::array kDialects = {kRs274ngc, kSinumerik, kFanuc, kPmac, kA3200, kAutomation1};

}  // namespace

std::span<const DialectFormats> dialect_formats() {
  return kDialects;
}

}  // namespace retrace::fabrication
