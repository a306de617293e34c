#pragma once

// Request for the properties of a design.

namespace retrace {

/// Settings for the properties of a design that its toolmaker needs.
struct InspectRequest {
  /// Minimum draft of the faces of the part: faces with less draft are listed, in degrees; >= 0 and <= 45.
  double min_draft_deg = 0.0;
  /// Angle between z and the direction in which the part leaves the mould of its back, in degrees; >= 0 and <= 60.
  double demould_tilt_deg = 0.0;
  /// Azimuth towards which this direction is tilted, from +x towards +y, in degrees; >= -360 and <= 360.
  double demould_azimuth_deg = 0.0;
};

}  // namespace retrace
