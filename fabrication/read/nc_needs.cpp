#include "fabrication/read/nc_needs.h"

#include <array>

namespace retrace::fabrication {
namespace {

constexpr NcNeed kDistanceNeed = {nc_said::kDistance, "G90 or G91", "to select absolute or incremental positions"};
constexpr NcNeed kFeedNeed = {nc_said::kFeedTime, "G94", "to select feeds per minute"};
constexpr NcNeed kInchNeed = {nc_said::kUnit, "G21", "to set the unit of lengths"};
constexpr NcNeed kOffsetNeed = {nc_said::kWorkOffset, "G54", "to select the work offset"};
constexpr NcNeed kRadiusNeed = {nc_said::kRadiusOff, "G40", "to switch off tool radius compensation"};
constexpr NcNeed kLengthNeed = {nc_said::kLengthOff, "G49", "to switch off tool length compensation"};
constexpr std::string_view kStopText = "to select exact stops; otherwise, corners are rounded";
constexpr std::string_view kFineStopText = "to make exact stops wait until the axes are in position";

/// Required settings of RS274/NGC. G92 offsets remain active after the control is switched off (LinuxCNC, G-code
/// reference, G92).
constexpr std::array kRs274ngc = {kInchNeed,
                                  kDistanceNeed,
                                  kFeedNeed,
                                  kOffsetNeed,
                                  NcNeed{nc_said::kShiftOff, "G92.1", "to cancel G92 offsets"},
                                  kRadiusNeed,
                                  kLengthNeed,
                                  NcNeed{nc_said::kExactStop, "G61.1 or G61", kStopText}};

/// Required settings of a Sinumerik. Frames and transformations remain active until they are cancelled or the control
/// is reset (Programming Manual Job Planning). With G603, the next block would begin while the axes are still moving.
constexpr std::array kSinumerik = {
    NcNeed{nc_said::kUnit, "G710", "to set the unit of lengths and feeds"},
    kDistanceNeed,
    kFeedNeed,
    kOffsetNeed,
    NcNeed{nc_said::kShiftOff, "TRANS", "to cancel programmed frames"},
    NcNeed{nc_said::kTransformationOff, "TRAFOOF", "to switch off transformations of the axes"},
    kRadiusNeed,
    NcNeed{nc_said::kLengthOff, "D0", "to deselect tool offsets"},
    NcNeed{nc_said::kExactStop, "G60", kStopText},
    NcNeed{nc_said::kFineStop, "G601", kFineStopText}};

constexpr std::array kFanuc = {kInchNeed,
                               kDistanceNeed,
                               kFeedNeed,
                               kOffsetNeed,
                               kRadiusNeed,
                               kLengthNeed,
                               NcNeed{nc_said::kExactStop, "G61", kStopText}};

/// Required settings of a Power PMAC. A coordinate system keeps the settings of the last program (Power PMAC User's
/// Manual).
constexpr std::array kPmac = {
    NcNeed{nc_said::kDistance, "abs or inc", "to select absolute or incremental positions"},
    NcNeed{nc_said::kFeedTime, "Coord[1].FeedTime", "to set the time unit of feeds"},
    NcNeed{nc_said::kFeedAxes, "frax(X,Y,Z)", "to select the axes whose path the feed applies to"},
    NcNeed{nc_said::kRadiusOff, "ccmode0", "to switch off tool radius compensation"},
    NcNeed{nc_said::kTransformationOff, "Coord[1].SegMoveTime=0", "to switch off transformations of the axes"},
    NcNeed{nc_said::kExactStop, "Coord[1].NoBlend=1", kStopText}};

/// Required settings of the Aerotech controls. A task keeps its modes between programs (Aerotech's knowledge base,
/// Introduction to Tasks).
constexpr NcNeed kFeedModeNeed = {nc_said::kFeedMode, "G94", "to select feeds as speeds instead of G93 or G95"};
constexpr NcNeed kToolOffsetNeed = {nc_said::kLengthOff, "G149", "to switch off tool offsets"};
constexpr std::array kA3200 = {NcNeed{nc_said::kUnit, "G71 or METRIC", "to set the unit of lengths"},
                               NcNeed{nc_said::kFeedTime, "G75 or MINUTES", "to set the time unit of feeds"},
                               kDistanceNeed,
                               kFeedModeNeed,
                               kRadiusNeed,
                               kToolOffsetNeed,
                               NcNeed{nc_said::kExactStop, "G109 or VELOCITY OFF", kStopText},
                               NcNeed{nc_said::kFineStop, "WAIT MODE INPOS", kFineStopText}};

constexpr std::array kAutomation1 = {
    NcNeed{nc_said::kUnit, "SetupTaskDistanceUnits(DistanceUnits.Primary)", "to set the unit of lengths"},
    NcNeed{nc_said::kFeedTime, "SetupTaskTimeUnits(TimeUnits.Minutes)", "to set the time unit of feeds"},
    kDistanceNeed,
    kFeedModeNeed,
    kRadiusNeed,
    kToolOffsetNeed,
    NcNeed{nc_said::kExactStop, "VelocityBlendingOff() or G109", kStopText},
    NcNeed{nc_said::kRoundingOff, "CornerRoundingOff()", "to switch off the rounding of corners"},
    NcNeed{nc_said::kFineStop, "SetupTaskWaitMode(WaitMode.InPosition)", kFineStopText}};

}  // namespace

std::span<const NcNeed> needs_of(NcDialect dialect) {
  switch (dialect) {
    case NcDialect::rs274ngc: return kRs274ngc;
    case NcDialect::sinumerik: return kSinumerik;
    case NcDialect::fanuc: return kFanuc;
    case NcDialect::pmac: return kPmac;
    case NcDialect::a3200: return kA3200;
    case NcDialect::automation1: break;
  }
  return kAutomation1;
}

}  // namespace retrace::fabrication
