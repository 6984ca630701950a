// How a tile is drawn. The morph is core/morph.ts in GLSL: change both together. `offsetM` and the
// lattice keep the sums exact, so the two sides of a seam come to the same gl_Position.
import {kMostHoldbacks} from '../core/holdback';
import {kWaterColor} from './water_shader';

const kPlace = /* glsl */ `
  attribute vec3 toTarget;
  uniform vec3 stepM;
  uniform vec3 offsetM;
  uniform vec3 eyeM;
  uniform vec3 originM;
  uniform float beginM;
  uniform float perM;
  uniform float exaggeration;
  uniform int holdbackCount;
  uniform highp sampler2D holdbacks;

  vec3 zUp(vec3 v) {
    return vec3(v.x, -v.z, v.y);
  }

  float shownDistance(vec3 base) {
    float distanceM = distance(base, eyeM);
    for (int i = 0; i < ${kMostHoldbacks}; ++i) {
      if (i >= holdbackCount) break;
      vec4 center = texelFetch(holdbacks, ivec2(i, 0), 0);
      vec3 halfM = texelFetch(holdbacks, ivec2(i, 1), 0).xyz;
      vec3 beside = max(abs(base - center.xyz) - halfM, 0.0);
      distanceM = max(distanceM, center.w - length(beside));
    }
    return distanceM;
  }

  vec4 toScreen(vec3 place) {
    vec3 seen = vec3(place.xy, place.z * exaggeration);
    return projectionMatrix * viewMatrix * vec4(seen, 1.0);
  }
`;

export const kVertexShader = /* glsl */ `
  ${kPlace}
  invariant gl_Position;
  attribute vec3 targetNormal;
  uniform float dropPerM;
  varying vec3 vNormal;
  varying float vHeightM;
  varying vec3 vFromEyeM;
  varying vec2 vPlan;
  #ifdef IMAGE
  attribute vec2 imagePlace;
  uniform vec4 imageSlope;
  uniform vec2 parentStart;
  uniform vec4 parentSlope;
  varying vec2 vImagePlace;
  varying vec2 vParentPlace;
  varying float vMorph;
  #endif
  #ifdef COLORS
  attribute vec3 vertexColor;
  attribute vec3 targetColor;
  varying vec3 vColor;
  #endif

  void main() {
    vec3 base = zUp(position) * stepM + offsetM;
    float t = clamp((shownDistance(base) - beginM) * perM, 0.0, 1.0);
    vec3 place = base + t * (zUp(toTarget) * stepM);
    // stored normals are those of the lattice, so they are divided by its steps
    vNormal = mix(normalize(zUp(normal) / stepM), normalize(zUp(targetNormal) / stepM), t);
    vPlan = place.xy + originM.xy;
    vHeightM = place.z + originM.z + dot(vPlan, vPlan) * dropPerM;
    vFromEyeM = place - eyeM;
    #ifdef IMAGE
    vec2 moved = t * zUp(toTarget).xy;
    vImagePlace = imagePlace + vec2(dot(imageSlope.xy, moved), dot(imageSlope.zw, moved));
    vec2 steps = zUp(position).xy + moved;
    vParentPlace = parentStart + vec2(dot(parentSlope.xy, steps), dot(parentSlope.zw, steps));
    vMorph = t;
    #endif
    #ifdef COLORS
    vColor = mix(vertexColor, targetColor, t);
    #endif
    gl_Position = toScreen(place);
  }
`;

/** Lines on the terrain: triangles and tile borders. */
export const kLineVertexShader = /* glsl */ `
  ${kPlace}
  void main() {
    vec3 base = zUp(position) * stepM + offsetM;
    float t = clamp((shownDistance(base) - beginM) * perM, 0.0, 1.0);
    gl_Position = toScreen(base + t * (zUp(toTarget) * stepM));
  }
`;

export const kLineFragmentShader = /* glsl */ `
  uniform vec4 lineColor;
  void main() {
    gl_FragColor = lineColor;
  }
`;

/** The sky in a direction; the haze far away has the colour of the horizon there. */
export const kSkyColor = /* glsl */ `
  uniform vec3 horizon;
  uniform vec3 zenith;
  uniform vec3 sun;
  uniform vec3 sunlight;
  uniform float sunGlow;

  vec3 skyColor(vec3 direction) {
    // below the horizon there is no ground: a calm backdrop for terrain seen from above
    vec3 below = mix(zenith, horizon, 0.45);
    float up = max(direction.z, 0.0);
    float down = 1.0 - up;
    vec3 color = mix(zenith, horizon, down * down * down);
    color = mix(color, below, smoothstep(0.0, 0.75, -direction.z));
    if (sunGlow == 0.0) return color;
    float glow = max(dot(direction, sun), 0.0);
    return color + sunGlow * sunlight * (0.25 * pow(glow, 12.0) + 0.5 * pow(glow, 400.0));
  }
`;

// All in sRGB: the usual way of shaded relief.
export const kFragmentShader = /* glsl */ `
  uniform int look;
  uniform sampler2D heightColors;
  uniform sampler2D slopeColors;
  uniform sampler2D errorColors;
  uniform vec2 heightsM;
  uniform vec3 levelColor;
  uniform float errorM;
  uniform float errorPerM;
  uniform float exaggeration;
  uniform vec3 skylight;
  uniform float hazePerM;
  uniform vec3 contours;
  uniform float contourStrength;
  uniform float levelSlope;
  varying vec3 vNormal;
  varying float vHeightM;
  varying vec3 vFromEyeM;
  varying vec2 vPlan;
  uniform float dropPerM;
  #ifdef IMAGE
  uniform sampler2D image;
  uniform sampler2D parentImage;
  varying vec2 vImagePlace;
  varying vec2 vParentPlace;
  varying float vMorph;
  #endif
  #ifdef COLORS
  varying vec3 vColor;
  #endif
  ${kSkyColor}
  ${kWaterColor}

  vec3 ramp(sampler2D colors, float share) {
    return texture2D(colors, vec2(clamp(share, 0.0, 1.0), 0.5)).rgb;
  }

  vec3 heightColor() {
    if (vHeightM < 0.0 && heightsM.x < 0.0) {
      return mix(vec3(0.62, 0.78, 0.87), vec3(0.16, 0.33, 0.52), sqrt(vHeightM / heightsM.x));
    }
    float low = max(heightsM.x, 0.0);
    return ramp(heightColors, (vHeightM - low) / (heightsM.y - low));
  }

  vec3 imageColor() {
    #ifdef IMAGE
    // a vertex may move beyond its own tile, but not beyond the parent's
    vec2 beyond = abs(vImagePlace - 0.5);
    float parentShare = max(beyond.x, beyond.y) > 0.5 ? 1.0 : vMorph;
    vec3 own = texture2D(image, vImagePlace).rgb;
    return mix(own, texture2D(parentImage, vParentPlace).rgb, parentShare);
    #else
    #ifdef COLORS
    return pow(vColor, vec3(1.0 / 2.2));  // glTF's colours are linear light
    #else
    return heightColor();
    #endif
    #endif
  }

  vec3 surfaceColor(vec3 n) {
    if (look == 1) return vec3(0.8, 0.8, 0.79);
    if (look == 2) return ramp(slopeColors, degrees(acos(clamp(n.z, 0.0, 1.0))) / 60.0);
    if (look == 3) return imageColor();
    if (look == 4) return levelColor;
    if (look == 5) return ramp(errorColors, errorM * errorPerM / length(vFromEyeM) / 1.25);
    return heightColor();
  }

  // color: what the look gives level ground
  vec3 waterSurface(vec3 color, vec3 light) {
    vec3 body = kWater;
    float shine = 1.0;
    if (look == 1) body = vec3(0.5, 0.56, 0.6);
    if (look == 2) body = kWaterOnMaps;
    if (look == 4) body = mix(color, kWaterOnMaps, 0.35);
    if (look == 5) body = color;
    if (look == 2) shine = 0.3;
    if (look == 4 || look == 5) shine = 0.2;
    #ifdef IMAGE
    if (look == 3) body = color;
    if (look == 3) shine = 0.6;
    #endif
    return waterColor(body, light, shine);
  }

  // 0 where the ground is as level as the mesh may be wrong: at a contour's height its lines would follow
  // the triangles there
  float relief() {
    vec3 up = cross(dFdx(vFromEyeM), dFdy(vFromEyeM));
    return smoothstep(0.15, 0.6, length(up.xy) / max(abs(up.z), 1e-12) / levelSlope);
  }

  // lines a pixel and a bit wide; every fifth is stronger; none where they would merge
  float contour(float intervalM) {
    float steps = vHeightM / intervalM;
    float perPx = max(fwidth(steps), 1e-6);
    float px = abs(fract(steps - 0.5) - 0.5) / perPx;
    float fifth = abs(fract(steps / 5.0 - 0.5) - 0.5) * 5.0 / perPx;
    float line = 0.7 * (1.0 - smoothstep(0.3, 1.2, px)) * (1.0 - smoothstep(0.12, 0.4, perPx));
    float strong = (1.0 - smoothstep(0.6, 1.6, fifth)) * (1.0 - smoothstep(0.6, 2.0, perPx));
    return max(line, 0.9 * strong);
  }

  void main() {
    #ifdef WATER
    vec3 n = vec3(0.0, 0.0, 1.0);
    #else
    vec3 n = normalize(vNormal);
    #endif
    vec3 color = surfaceColor(n);
    n = normalize(vec3(n.xy, n.z / exaggeration));
    float sky = 0.5 + 0.5 * n.z;
    vec3 light = skylight * (0.25 + 0.75 * sky) + sunlight * max(dot(n, sun), 0.0);
    // where colours are to be read, or have shadows of their own, shading only hints at the shape
    bool isReading = look >= 2;
    if (isReading) light = mix(vec3(1.0), light, 0.5);
    #ifdef WATER
    color = waterSurface(color, light);
    #else
    color *= light;
    if (contourStrength > 0.0) {
      float line = mix(contour(contours.x), contour(contours.y), contours.z);
      color = mix(color, color * vec3(0.42, 0.3, 0.2), contourStrength * relief() * line);
    }
    #endif
    if (hazePerM > 0.0) {
      float far = length(vFromEyeM) * hazePerM;
      vec3 direction = normalize(vFromEyeM);
      color = mix(skyColor(vec3(direction.xy, max(direction.z, 0.0))), color, exp(-far * far));
    }
    gl_FragColor = vec4(color, 1.0);
  }
`;
