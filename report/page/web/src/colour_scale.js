// Colours as lists of red, green and blue, 0 to 255.

/** Returns the colour of a text such as "#1d6fa5". */
export function rgbOf(hex) {
  return [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16));
}

/** Returns the colour at a position 0..1 on a scale, by linear interpolation between its equidistant colours. */
export function colourOnScale(scale, position) {
  const at = position * (scale.length - 1);
  const low = Math.min(scale.length - 2, Math.floor(at));
  return scale[low].map((c, k) => Math.round(c + (at - low) * (scale[low + 1][k] - c)));
}
