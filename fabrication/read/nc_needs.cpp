#include "fabrication/read/nc_needs.h"

#include <array>

namespace retrace::fabrication {
namespace {

constexpr NcNeed kDistanceNeed = {nc_said::kDistance, "G90 or G91", "whether positions are absolute or incremental"};
constexpr NcNeed kFeedNeed = {nc_said::kFeedTime, "G94", "that feeds are per minute"};
constexpr NcNeed kInchNeed = {nc_said::kUnit, "G21", "the unit of lengths"};
constexpr NcNeed kOffsetNeed = {nc_said::kWorkOffset, "G54", "which zero of the workpiece holds"};
constexpr NcNeed kRadiusNeed = {nc_said::kRadiusOff, "G40", "that no radius of the tool is compensated"};
constexpr NcNeed kLengthNeed = {nc_said::kLengthOff, "G49", "that no length of the tool is compensated"};
constexpr std::string_view kStopText = "that moves stop exactly: corners would be rounded";
constexpr std::string_view kFineStopText = "that stops wait for the axes' exact positions";

/// Required settings of RS274/NGC. G92 offsets remain active after the control is switched off (LinuxCNC, G-code
/// reference, G92).
constexpr std::array kRs274ngc = {kInchNeed,
                                  kDistanceNeed,
                                  kFeedNeed,
                                  kOffsetNeed,
                                  NcNeed{nc_said::kShiftOff, "G92.1", "that shifts of the zero by G92 are cancelled"},
                                  kRadiusNeed,
                                  kLengthNeed,
                                  NcNeed{nc_said::kExactStop, "G61.1 or G61", kStopText}};

/// Required settings of a Sinumerik. Frames and transformations remain active until they are cancelled or the control
/// is reset (Programming Manual Job Planning). With G603, the next block would begin while the axes are still moving.
constexpr std::array kSinumerik = {
    NcNeed{nc_said::kUnit, "G710", "the unit of lengths and feeds"},
    kDistanceNeed,
    kFeedNeed,
    kOffsetNeed,
    NcNeed{nc_said::kShiftOff, "TRANS", "that programmed frames are cancelled"},
    NcNeed{nc_said::kTransformationOff, "TRAFOOF", "that the control transforms no axes"},
    kRadiusNeed,
    NcNeed{nc_said::kLengthOff, "D0", "that no offset of the tool holds"},
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
    NcNeed{nc_said::kDistance, "abs or inc", "whether positions are absolute or incremental"},
    NcNeed{nc_said::kFeedTime, "Coord[1].FeedTime", "what time feeds are per"},
    NcNeed{nc_said::kFeedAxes, "frax(X,Y,Z)", "which axes feeds belong to"},
    NcNeed{nc_said::kRadiusOff, "ccmode0", "that no radius of the tool is compensated"},
    NcNeed{nc_said::kTransformationOff, "Coord[1].SegMoveTime=0", "that the control transforms no axes"},
    NcNeed{nc_said::kExactStop, "Coord[1].NoBlend=1", kStopText}};

/// Required settings of the Aerotech controls. A task keeps its modes between programs (Aerotech's knowledge base,
/// Introduction to Tasks).
constexpr NcNeed kFeedModeNeed = {nc_said::kFeedMode, "G94", "that feeds are speeds: not G93, not G95"};
constexpr NcNeed kToolOffsetNeed = {nc_said::kLengthOff, "G149", "that no offset of the tool holds"};
constexpr std::array kA3200 = {NcNeed{nc_said::kUnit, "G71 or METRIC", "the unit of lengths"},
                               NcNeed{nc_said::kFeedTime, "G75 or MINUTES", "what time feeds are per"},
                               kDistanceNeed,
                               kFeedModeNeed,
                               kRadiusNeed,
                               kToolOffsetNeed,
                               NcNeed{nc_said::kExactStop, "G109 or VELOCITY OFF", kStopText},
                               NcNeed{nc_said::kFineStop, "WAIT MODE INPOS", kFineStopText}};

constexpr std::array kAutomation1 = {
    NcNeed{nc_said::kUnit, "SetupTaskDistanceUnits(DistanceUnits.Primary)", "the unit of lengths"},
    NcNeed{nc_said::kFeedTime, "SetupTaskTimeUnits(TimeUnits.Minutes)", "what time feeds are per"},
    kDistanceNeed,
    kFeedModeNeed,
    kRadiusNeed,
    kToolOffsetNeed,
    NcNeed{nc_said::kExactStop, "VelocityBlendingOff() or G109", kStopText},
    NcNeed{nc_said::kRoundingOff, "CornerRoundingOff()", "that no arcs are put between lines"},
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
