import {Color, DoubleSide, GLSL3, LinearSRGBColorSpace, ShaderMaterial, Vector2, Vector3} from 'three';
import type {VolumeData} from './volume_data';

/** Surfaces and materials that the shader has room for. */
export const kMostSurfaces = 8;
export const kMostMaterials = 32;
/** Materials with a value of their own at each corner. */
export const kMostValues = 8;

// rock, water, air and more: as in the SVG of sections, told apart in grey, too
const kColors = ['#8a6d4b', '#3d7fc1', '#e8f0f5', '#c9a227', '#6b8e4e', '#a34a3f', '#7d5fa6', '#4f5b66'];

export function materialColor(material: number): string {
  return kColors[material % kColors.length];
}

/** Blue over white to red, at 0 to 1; also in the shader below. */
export function rampColor(t: number): string {
  const red = t < 0.5 ? 0.2 + 1.6 * t : 1;
  const blue = t < 0.5 ? 1 : 1 - 1.6 * (t - 0.5);
  const green = 1 - 1.5 * Math.abs(t - 0.5);
  return `rgb(${[red, green, blue].map((v) => Math.round(255 * v)).join(' ')})`;
}

const kVertexShader = `
in vec4 distances0;
in vec4 distances1;
in vec4 values0;
in vec4 values1;
out vec4 d0;
out vec4 d1;
out vec4 v0;
out vec4 v1;
void main() {
  d0 = distances0;
  d1 = distances1;
  v0 = values0;
  v1 = values1;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;

// distances and values are linear in a cell, and so in its polygon: the material of each pixel is
// exactly that of the approximation, whatever the size of the cell
const kFragmentShader = `
uniform int materialCount;
uniform int below[${kMostMaterials}];
uniform int above[${kMostMaterials}];
uniform bool isEmpty[${kMostMaterials}];
uniform vec3 colors[${kMostMaterials}];
uniform bool showsField;
uniform vec2 range;
in vec4 d0;
in vec4 d1;
in vec4 v0;
in vec4 v1;
out vec4 color;
vec3 ramp(float t) {
  return vec3(t < 0.5 ? 0.2 + 1.6 * t : 1.0, 1.0 - 1.5 * abs(t - 0.5),
              t < 0.5 ? 1.0 : 1.0 - 1.6 * (t - 0.5));
}
void main() {
  int sides = 0;
  for (int i = 0; i < 4; ++i) {
    if (d0[i] < 0.0) sides |= 1 << i;
    if (d1[i] < 0.0) sides |= 1 << (i + 4);
  }
  int material = materialCount - 1;
  for (int m = materialCount - 1; m >= 0; --m) {
    if ((sides & below[m]) == below[m] && (sides & above[m]) == 0) material = m;
  }
  vec3 shown = colors[material];
  if (showsField && !isEmpty[material]) {
    float value = material < 4 ? v0[material] : v1[material - 4];
    shown = ramp(clamp((value - range.x) / max(range.y - range.x, 1e-30), 0.0, 1.0));
  }
  // through what is empty the surfaces behind it can be seen
  color = vec4(shown, isEmpty[material] ? 0.35 : 1.0);
}`;

/** Colours a section by material or by a field: the colours are those of the screen. */
export function sectionMaterial({materials}: VolumeData): ShaderMaterial {
  const filled = <T>(of: (m: number) => T, none: T) =>
    Array.from({length: kMostMaterials}, (_, m) => (m < materials.length ? of(m) : none));
  const rgb = (m: number) => {
    const {r, g, b} = new Color().setStyle(materialColor(m), LinearSRGBColorSpace);
    return new Vector3(r, g, b);
  };
  return new ShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: kVertexShader,
    fragmentShader: kFragmentShader,
    side: DoubleSide,
    transparent: true,
    // mesh lines are drawn over it
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
    uniforms: {
      materialCount: {value: materials.length},
      below: {value: filled((m) => materials[m].below, 0)},
      above: {value: filled((m) => materials[m].above, 0)},
      isEmpty: {value: filled((m) => materials[m].isEmpty, true)},
      colors: {value: filled(rgb, new Vector3())},
      showsField: {value: false},
      range: {value: new Vector2(0, 1)},
    },
  });
}
