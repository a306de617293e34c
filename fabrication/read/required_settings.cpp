#include "fabrication/read/required_settings.h"

#include <array>

#include "core/joined_arrays.h"

namespace retrace::fabrication {
namespace {

constexpr RequiredSetting kDistanceNeed = {nc_setting::kDistance, "G90 or G91",
                                           "to select absolute or incremental positions"};
constexpr RequiredSetting kFeedNeed = {nc_setting::kFeedTime, "G94", "to select feeds per minute"};
constexpr RequiredSetting kInchNeed = {nc_setting::kUnit, "G21", "to set the unit of lengths"};
constexpr RequiredSetting kOffsetNeed = {nc_setting::kWorkOffset, "G54", "to select the work offset"};
constexpr RequiredSetting kRadiusNeed = {nc_setting::kRadiusOff, "G40", "to switch off tool radius compensation"};
constexpr RequiredSetting kLengthNeed = {nc_setting::kLengthOff, "G49", "to switch off tool length compensation"};
constexpr std::string_view kStopText = "to select exact stops; otherwise, corners are rounded";
constexpr std::string_view kFineStopText = "to make exact stops wait until the axes are in position";

/// Required settings of RS274/NGC. G92 offsets remain active after the control is switched off (LinuxCNC, G-code
/// reference, G92).
constexpr std::array kRs274ngc = {kInchNeed,
                                  kDistanceNeed,
                                  kFeedNeed,
                                  kOffsetNeed,
                                  RequiredSetting{nc_setting::kShiftOff, "G92.1", "to cancel G92 offsets"},
                                  kRadiusNeed,
                                  kLengthNeed,
                                  RequiredSetting{nc_setting::kExactStop, "G61.1 or G61", kStopText}};

/// Required settings of a Sinumerik. Frames and transformations remain active until they are cancelled or the control
/// is reset (Programming Manual Job Planning). With G603, the next block would begin while the axes are still moving.
constexpr std::array kSinumerik = {
    RequiredSetting{nc_setting::kUnit, "G710", "to set the unit of lengths and feeds"},
    kDistanceNeed,
    kFeedNeed,
    kOffsetNeed,
    RequiredSetting{nc_setting::kShiftOff, "TRANS", "to cancel programmed frames"},
    RequiredSetting{nc_setting::kTransformationOff, "TRAFOOF", "to switch off transformations of the axes"},
    kRadiusNeed,
    RequiredSetting{nc_setting::kLengthOff, "D0", "to deselect tool offsets"},
    RequiredSetting{nc_setting::kExactStop, "G60", kStopText},
    RequiredSetting{nc_setting::kFineStop, "G601", kFineStopText}};

constexpr std::array kFanuc = {kInchNeed,
                               kDistanceNeed,
                               kFeedNeed,
                               kOffsetNeed,
                               kRadiusNeed,
                               kLengthNeed,
                               RequiredSetting{nc_setting::kExactStop, "G61", kStopText}};

/// Required settings of a Power PMAC. A coordinate system keeps the settings of the last program (Power PMAC User's
/// Manual).
constexpr std::array kPmac = {
    RequiredSetting{nc_setting::kDistance, "abs or inc", "to select absolute or incremental positions"},
    RequiredSetting{nc_setting::kFeedTime, "Coord[1].FeedTime", "to set the time unit of feeds"},
    RequiredSetting{nc_setting::kFeedAxes, "frax(X,Y,Z)", "to select the axes whose path the feed applies to"},
    RequiredSetting{nc_setting::kRadiusOff, "ccmode0", "to switch off tool radius compensation"},
    RequiredSetting{nc_setting::kTransformationOff, "Coord[1].SegMoveTime=0",
                    "to switch off transformations of the axes"},
    RequiredSetting{nc_setting::kExactStop, "Coord[1].NoBlend=1", kStopText}};

/// Required settings of the Aerotech controls. A task keeps its modes between programs (Aerotech's knowledge base,
/// Introduction to Tasks).
constexpr RequiredSetting kFeedModeNeed = {nc_setting::kFeedMode, "G94",
                                           "to select feeds as speeds instead of G93 or G95"};
constexpr RequiredSetting kToolOffsetNeed = {nc_setting::kLengthOff, "G149", "to switch off tool offsets"};
/// Returns the settings that both Aerotech controls require, with the words of one control.
constexpr std::array<RequiredSetting, 7> aerotech_settings(std::string_view unit, std::string_view feed_time,
                                                           std::string_view exact_stop) {
  return {RequiredSetting{nc_setting::kUnit, unit, "to set the unit of lengths"},
          RequiredSetting{nc_setting::kFeedTime, feed_time, "to set the time unit of feeds"},
          kDistanceNeed,
          kFeedModeNeed,
          kRadiusNeed,
          kToolOffsetNeed,
          RequiredSetting{nc_setting::kExactStop, exact_stop, kStopText}};
}
constexpr auto kA3200 = joined(aerotech_settings("G71 or METRIC", "G75 or MINUTES", "G109 or VELOCITY OFF"),
                               std::array{RequiredSetting{nc_setting::kFineStop, "WAIT MODE INPOS", kFineStopText}});
constexpr auto kAutomation1 = joined(
    aerotech_settings("SetupTaskDistanceUnits(DistanceUnits.Primary)", "SetupTaskTimeUnits(TimeUnits.Minutes)",
                      "VelocityBlendingOff() or G109"),
    std::array{
        RequiredSetting{nc_setting::kRoundingOff, "CornerRoundingOff()", "to switch off the rounding of corners"},
        RequiredSetting{nc_setting::kFineStop, "SetupTaskWaitMode(WaitMode.InPosition)", kFineStopText}});

}  // namespace

std::span<const RequiredSetting> required_settings_of(NcDialect dialect) {
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
