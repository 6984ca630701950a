// How water is drawn: its own colour where one looks down on it, the sky where one looks along it, on
// ripples that stand still, as the page draws only when something moves.

/** Colours of water, and of water where a look has colours of its own; sRGB. */
export const kWater = 0x2f6f93;
export const kWaterOnMaps = 0xa9cbdd;

const glsl = (hex: number) =>
  `vec3(${[hex >> 16, (hex >> 8) & 255, hex & 255].map((v) => (v / 255).toFixed(4)).join(', ')})`;

/** For a fragment shader that has kSkyColor, vPlan, vFromEyeM, dropPerM, exaggeration and skylight. */
export const kWaterColor = /* glsl */ `
  const vec3 kWater = ${glsl(kWater)};
  const vec3 kWaterOnMaps = ${glsl(kWaterOnMaps)};

  float hashOf(vec2 cell) {
    vec3 p = fract(mod(cell, 1024.0).xyx * 0.1031);
    p += dot(p, p.yzx + 33.33);
    return fract((p.x + p.y) * p.z);
  }

  // a smooth random height from 0 to 1 and its slope
  vec3 swell(vec2 at) {
    vec2 cell = floor(at);
    vec2 f = at - cell;
    vec2 u = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    vec2 du = 30.0 * f * f * (f * (f - 2.0) + 1.0);
    float a = hashOf(cell);
    float b = hashOf(cell + vec2(1.0, 0.0)) - a;
    float c = hashOf(cell + vec2(0.0, 1.0)) - a;
    float d = hashOf(cell + vec2(1.0, 1.0)) - a - b - c;
    return vec3(a + b * u.x + c * u.y + d * u.x * u.y, du * (vec2(b, c) + d * u.yx));
  }

  // waves of a length of 2^octave metres, and others across them
  vec3 waves(float octave) {
    vec2 at = vPlan * exp2(-octave);
    vec3 along = swell(at * vec2(0.8, 1.25));
    vec3 across = swell(mat2(0.83, 0.56, -0.56, 0.83) * at * 1.9 + octave);
    return 0.6 * along + 0.4 * across;
  }

  // as long as some pixels at any distance: ripples are seen from near, and never flicker far away
  vec3 waves() {
    const float pixels = 9.0, leastM = 8.0;
    vec2 spread = max(abs(dFdx(vPlan)), abs(dFdy(vPlan)));
    float octave = log2(max(pixels * max(spread.x, spread.y), leastM));
    return mix(waves(floor(octave)), waves(floor(octave) + 1.0), fract(octave));
  }

  // body: the water's own colour; light: what falls on it; shine: how much it mirrors, 0 to 1
  vec3 waterColor(vec3 body, vec3 light, float shine) {
    vec3 up = normalize(vec3(2.0 * dropPerM * vPlan, 1.0));
    vec3 wave = waves();
    vec3 n = normalize(up - vec3(0.055 * wave.yz, 0.0));
    vec3 ray = normalize(vec3(vFromEyeM.xy, vFromEyeM.z * exaggeration));
    vec3 mirrored = reflect(ray, n);
    mirrored.z = abs(mirrored.z);
    float grazing = 1.0 - max(dot(-ray, n), 0.0);
    float fresnel = 0.03 + 0.7 * pow(grazing, 3.4);
    // one looks deeper down than along, and at night into the dark
    float brightness = dot(light, vec3(0.3, 0.6, 0.1));
    float depth = mix(0.86, 1.04, grazing) * mix(0.55, 1.0, smoothstep(0.2, 0.7, brightness));
    body *= mix(1.0, depth, shine) * (0.96 + 0.08 * wave.x);
    vec3 color = mix(body * light, skyColor(mirrored), shine * fresnel);
    float glint = pow(max(dot(mirrored, sun), 0.0), 220.0);
    return color + shine * glint * mix(0.2, 0.8, sunGlow) * sunlight;
  }
`;
