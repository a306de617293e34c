#pragma once

// Limits of chisels that jobs, plans and studies share.

namespace retrace::fabrication {

/// Allowed excess of a tool's width over an element's width: one nanometre.
inline constexpr double kFitToleranceMm = 1e-6;
/// Minimum and maximum width of a chisel.
inline constexpr double kMinToolWidthMm = 0.1;
inline constexpr double kMaxToolWidthMm = 2.0;
/// Maximum length that one edge may cut.
inline constexpr double kMaxEdgeLifeMm = 1e9;

}  // namespace retrace::fabrication
