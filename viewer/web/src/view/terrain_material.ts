import {Color, ShaderMaterial, Vector2, Vector3, type IUniform} from 'three';
import type {MorphUniforms} from '../core/morph';
import {heightColors} from './height_colors';

/** Uniforms that all tiles share; change a value and every tile follows. */
export interface SharedUniforms {
  readonly [name: string]: IUniform;
  readonly eyeM: IUniform<Vector3>;
  /** The render origin in the world. */
  readonly originM: IUniform<Vector3>;
  /** Lowest and highest height. */
  readonly heightsM: IUniform<Vector2>;
  /** 1 / (2 R) of the ellipsoid, or 0: how far the world falls below its tangent plane. */
  readonly dropPerM: IUniform<number>;
  /** 1: colours tell the level; 0: the height. */
  readonly levelColors: IUniform<number>;
}

const kEarthRadiusM = 6371008.8;

export function sharedUniforms(minHeightM: number, maxHeightM: number, curved: boolean) {
  const uniforms: SharedUniforms = {
    eyeM: {value: new Vector3()},
    originM: {value: new Vector3()},
    heightsM: {value: new Vector2(minHeightM, Math.max(maxHeightM, minHeightM + 1))},
    dropPerM: {value: curved ? 1 / (2 * kEarthRadiusM) : 0},
    levelColors: {value: 0},
    colors: {value: heightColors()},
  };
  return uniforms;
}

// The morph is core/morph.ts in GLSL: change both together. `offsetM` and the lattice keep the sums
// exact, so the two sides of a seam come to the same gl_Position.
const kVertexShader = /* glsl */ `
  attribute vec3 toTarget;
  attribute vec3 targetNormal;
  uniform vec3 stepM;
  uniform vec3 offsetM;
  uniform vec3 eyeM;
  uniform vec3 originM;
  uniform float beginM;
  uniform float perM;
  uniform float dropPerM;
  varying vec3 vNormal;
  varying float vHeightM;

  vec3 zUp(vec3 v) {
    return vec3(v.x, -v.z, v.y);
  }

  void main() {
    vec3 base = zUp(position) * stepM + offsetM;
    float t = clamp((distance(base, eyeM) - beginM) * perM, 0.0, 1.0);
    vec3 place = base + t * (zUp(toTarget) * stepM);
    // stored normals are those of the lattice, so they are divided by its steps
    vNormal = mix(normalize(zUp(normal) / stepM), normalize(zUp(targetNormal) / stepM), t);
    vec2 plan = place.xy + originM.xy;
    vHeightM = place.z + originM.z + dot(plan, plan) * dropPerM;
    gl_Position = projectionMatrix * viewMatrix * vec4(place, 1.0);
  }
`;

// The sun stands in the north-west, 45 degrees high; sky light from above keeps slopes that face
// away from it readable. All in sRGB: the usual way of shaded relief.
const kFragmentShader = /* glsl */ `
  uniform sampler2D colors;
  uniform vec2 heightsM;
  uniform vec3 levelColor;
  uniform float levelColors;
  varying vec3 vNormal;
  varying float vHeightM;

  const vec3 kSun = vec3(-0.5, 0.5, 0.70710678);

  void main() {
    vec3 n = normalize(vNormal);
    float share = (vHeightM - heightsM.x) / (heightsM.y - heightsM.x);
    vec3 color = texture2D(colors, vec2(clamp(share, 0.0, 1.0), 0.5)).rgb;
    color = mix(color, levelColor, levelColors);
    float sun = max(dot(n, kSun), 0.0);
    float sky = 0.5 + 0.5 * n.z;
    gl_FragColor = vec4(color * (0.38 * sky + 0.72 * sun + 0.12), 1.0);
  }
`;

/** Set apart by hue, neighbours by lightness too; level 0 is the warmest. */
const kLevelColors = [0xe4572e, 0xf3a712, 0xa8c686, 0x669bbc, 0x8c6bb1, 0xd98cb3, 0x8d99ae];

/** The material of one tile. The program is the same for all, so three compiles it once. */
export function terrainMaterial(shared: SharedUniforms, level: number): ShaderMaterial {
  return new ShaderMaterial({
    vertexShader: kVertexShader,
    fragmentShader: kFragmentShader,
    uniforms: {
      ...shared,
      stepM: {value: new Vector3()},
      offsetM: {value: new Vector3()},
      beginM: {value: 0},
      perM: {value: 0},
      // set as it is: the shader writes to the screen without conversion
      levelColor: {value: new Color().setHex(kLevelColors[level % kLevelColors.length]!, '')},
    },
  });
}

/** Hands one frame's morph to a tile's material. The eye is a shared uniform. */
export function setMorph(material: ShaderMaterial, morph: MorphUniforms): void {
  const {uniforms} = material;
  uniforms.stepM!.value.fromArray(morph.stepM);
  uniforms.offsetM!.value.fromArray(morph.offsetM);
  uniforms.beginM!.value = morph.beginM;
  uniforms.perM!.value = morph.perM;
}
