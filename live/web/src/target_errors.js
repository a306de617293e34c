// Target errors of RRE. They are standard errors if weak beams are resampled, and otherwise the untraced power.
export const MOVING = 1e-4; // while the user makes changes
export const RESTING = 1e-6; // while the user makes no changes
export const AT_ONCE = 1e-3; // first accuracy for the many directions of curves and maps
