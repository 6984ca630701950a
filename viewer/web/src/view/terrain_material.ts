import {
  Color,
  DataTexture,
  FloatType,
  RGBAFormat,
  ShaderMaterial,
  Texture,
  Vector2,
  Vector3,
  Vector4,
  type IUniform,
} from 'three';
import type {Daylight} from '../core/daylight';
import {kMostHoldbacks} from '../core/holdback';
import type {ImageMap} from '../core/image_map';
import type {HoldbackUniform, MorphUniforms} from '../core/morph';
import type {Tile, Tileset} from '../core/tileset';
import {levelColor, rampTexture} from './color_ramps';
import {
  kFragmentShader,
  kLineFragmentShader,
  kLineVertexShader,
  kVertexShader,
} from './terrain_shader';

/** Uniforms that all tiles share; change a value and every tile follows. */
export type SharedUniforms = ReturnType<typeof sharedUniforms>;

const kEarthRadiusM = 6371008.8;

/** The uniforms at their start values; terrain_view.ts and below set them. */
export function sharedUniforms({minHeightM, maxHeightM, curved, levels, cellM}: Tileset) {
  return {
    eyeM: {value: new Vector3()},
    /** The render origin in the world. */
    originM: {value: new Vector3()},
    /** Heights are drawn this many times as high. */
    exaggeration: {value: 1},
    holdbackCount: {value: 0},
    holdbacks: {value: holdbackTexture()},
    heightsM: {value: new Vector2(minHeightM, Math.max(maxHeightM, minHeightM + 1))},
    /** 1 / (2 R) of the Earth, or 0: how far the world falls below its tangent plane. */
    dropPerM: {value: curved ? 1 / (2 * kEarthRadiusM) : 0},
    /** Index into kLooks. */
    look: {value: 0},
    heightColors: {value: rampTexture('relief')},
    slopeColors: {value: rampTexture('slope')},
    errorColors: {value: rampTexture('error')},
    /** Wanted tolerances that a metre of error is at a metre's distance. */
    errorPerM: {value: 1},
    /** Interval, next interval, blend; and 0 where there are none. */
    contours: {value: new Vector3(1, 2, 0)},
    contourStrength: {value: 0},
    /** Rise of the tolerance over a cell: the same at all levels of a ladder. */
    levelSlope: {value: levels[0]!.toleranceM / cellM},
    hazePerM: {value: 0},
    sun: {value: new Vector3(0, 0, 1)},
    sunlight: {value: new Vector3()},
    skylight: {value: new Vector3()},
    horizon: {value: new Vector3()},
    zenith: {value: new Vector3()},
    sunGlow: {value: 0},
  };
}

/**
 * A column for each holdback: its centre and height; its half sizes. Arrays of uniforms would be handed over anew
 * for every tile.
 */
function holdbackTexture(): DataTexture {
  const texels = new Float32Array(2 * 4 * kMostHoldbacks);
  return new DataTexture(texels, kMostHoldbacks, 2, RGBAFormat, FloatType);
}

export function setDaylight(shared: SharedUniforms, light: Daylight, glow: number): void {
  for (const name of ['sun', 'sunlight', 'skylight', 'horizon', 'zenith'] as const) {
    shared[name].value.fromArray(light[name]);
  }
  shared.sunGlow.value = glow;
}

export function setHoldbacks(shared: SharedUniforms, holdbacks: readonly HoldbackUniform[]): void {
  shared.holdbackCount.value = holdbacks.length;
  if (holdbacks.length === 0) return;
  const texture = shared.holdbacks.value;
  const texels = texture.image.data as Float32Array;
  holdbacks.forEach(({centerM, halfM, heightM}, i) => {
    texels.set([...centerM, heightM], 4 * i);
    texels.set(halfM, 4 * (kMostHoldbacks + i));
  });
  texture.needsUpdate = true;
}

/** What lies on the terrain of a tile. */
export interface Drape {
  readonly image: Texture | undefined;
  readonly imageMap: ImageMap;
  readonly hasColors: boolean;
}

/** The material of one tile. The program is the same for all, so three compiles it once. */
export function terrainMaterial(shared: SharedUniforms, tile: Tile, drape: Drape): ShaderMaterial {
  return new ShaderMaterial({
    vertexShader: kVertexShader,
    fragmentShader: kFragmentShader,
    // lines lie on triangles: those step back a little where lines are shown
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 2,
    defines: {...(drape.image && {IMAGE: 1}), ...(drape.hasColors && {COLORS: 1})},
    uniforms: {
      ...(shared as Record<string, IUniform>),
      stepM: {value: new Vector3()},
      offsetM: {value: new Vector3()},
      beginM: {value: 0},
      perM: {value: 0},
      errorM: {value: tile.errorM},
      image: {value: drape.image ?? null},
      imageSlope: {value: new Vector4(...drape.imageMap.slope)},
      parentImage: {value: null},
      parentStart: {value: new Vector2()},
      parentSlope: {value: new Vector4()},
      // set as it is: the shader writes to the screen without conversion
      levelColor: {value: new Color().setHex(levelColor(tile.level), '')},
    },
  });
}

/**
 * Draws the water of a tile, by a program of its own: software that draws runs both sides of a branch. Its vertices
 * come to the very same places, as gl_Position is invariant.
 */
export function waterMaterial(tile: ShaderMaterial): ShaderMaterial {
  const {vertexShader, fragmentShader, polygonOffsetFactor, polygonOffsetUnits, uniforms} = tile;
  return new ShaderMaterial({
    ...{vertexShader, fragmentShader, polygonOffsetFactor, polygonOffsetUnits, uniforms},
    defines: {...tile.defines, WATER: 1},
  });
}

/** Lines that morph as a tile does. */
export function lineMaterial(tile: ShaderMaterial, color: Vector4, wireframe: boolean) {
  return new ShaderMaterial({
    vertexShader: kLineVertexShader,
    fragmentShader: kLineFragmentShader,
    uniforms: {...tile.uniforms, lineColor: {value: color}},
    transparent: true,
    wireframe,
  });
}

/** Hands a tile the image that it blends into, and how that lies on it. */
export function setParentImage({uniforms}: ShaderMaterial, image: Texture, map: ImageMap): void {
  uniforms.parentImage!.value = image;
  uniforms.parentStart!.value.fromArray(map.start);
  uniforms.parentSlope!.value.fromArray(map.slope);
}

/** Hands one frame's morph to a tile's material. Eye and holdbacks are shared uniforms. */
export function setMorph(material: ShaderMaterial, morph: MorphUniforms): void {
  const {uniforms} = material;
  uniforms.stepM!.value.fromArray(morph.stepM);
  uniforms.offsetM!.value.fromArray(morph.offsetM);
  uniforms.beginM!.value = morph.beginM;
  uniforms.perM!.value = morph.perM;
}
