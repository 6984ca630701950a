/** From above one side of a world box down to the ground in the middle; t from 0 to 1. */
export function flightPose({min, max}, t) {
  const at = (k, share) => min[k] + share * (max[k] - min[k]);
  const size = Math.hypot(max[0] - min[0], max[1] - min[1]);
  const eye = [
    at(0, 0.3 + 0.3 * t),
    at(1, 0.1 + 0.4 * t),
    max[2] + size * (0.02 + 0.3 * (1 - t) ** 2),
  ];
  return {eye, headingDeg: 20 * t, pitchDeg: -40 + 15 * t};
}
