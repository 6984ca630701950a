import {
  BufferAttribute,
  BufferGeometry,
  LinearMipmapLinearFilter,
  LineSegments,
  Mesh,
  Texture,
  Vector4,
  type Material,
  type ShaderMaterial,
} from 'three';
import {borderOf} from '../core/border';
import type {GlbTile} from '../core/glb';
import {imageMap, kNoImage, mapOfParent, type ImageMap} from '../core/image_map';
import {
  targetColors,
  targetNormals,
  targetVertices,
  type TileVertices,
} from '../core/target_vertices';
import type {Level, Tile} from '../core/tileset';
import {
  lineMaterial,
  setParentImage,
  terrainMaterial,
  waterMaterial,
  type SharedUniforms,
} from './terrain_material';
import type {Decoded} from './tile_decoder';

/** A tile that is loaded: its integers, and the mesh to draw. */
export interface TileContent extends TileVertices {
  readonly bytes: number;
  readonly triangles: number;
  readonly positions: GlbTile['positions'];
  readonly toTargets: GlbTile['toTargets'];
  readonly indices: GlbTile['indices'];
  readonly imageMap: ImageMap;
  readonly hasDrape: boolean;
  readonly hasWater: boolean;
  /** Holds the uniforms of everything that is drawn of the tile. */
  readonly material: ShaderMaterial;
  readonly mesh: Mesh<BufferGeometry>;
  /** Lines over it, made when they are first shown. */
  triangleLines?: Mesh;
  borderLines?: LineSegments;
}

/** Largest angle sideways at which an image stays sharp; a setting of the graphics card. */
const kAnisotropy = 8;

/** Makes what is drawn of a decoded tile. */
export function makeContent(
  {tile: glb, image}: Decoded,
  tile: Tile,
  levels: readonly Level[],
  shared: SharedUniforms,
): TileContent {
  const {origin, positions, toTargets, normals, indices, landIndices, colors, places} = glb;
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(positions, 3));
  geometry.setAttribute('toTarget', new BufferAttribute(toTargets, 3));
  geometry.setAttribute('normal', new BufferAttribute(normals, 3, true));
  if (colors) geometry.setAttribute('vertexColor', new BufferAttribute(colors, 3, true));
  if (places) geometry.setAttribute('imagePlace', new BufferAttribute(places, 2));
  geometry.setIndex(new BufferAttribute(indices, 1));
  geometry.addGroup(0, landIndices, 0);
  geometry.addGroup(landIndices, indices.length - landIndices, 1);

  const texture = image && places ? textureOf(image) : undefined;
  const map = places ? imageMap(positions, places) : kNoImage;
  const drape = {image: texture, imageMap: map, hasColors: colors !== undefined};
  const material = terrainMaterial(shared, tile, drape);
  const hasWater = landIndices < indices.length;
  const mesh = fixed(new Mesh(geometry, hasWater ? [material, waterMaterial(material)] : material));
  // what the arrays take here and on the card, target normals and colours included
  const arrays = 2 * (2 * positions.byteLength + 2 * normals.byteLength + indices.byteLength);
  const pixels = image ? (4 / 3) * 4 * image.width * image.height : 0;
  const more = 2 * (2 * (colors?.byteLength ?? 0) + (places?.byteLength ?? 0));
  return {
    bytes: arrays + pixels + more,
    triangles: indices.length / 3,
    stepM: levels[tile.level]!.stepM,
    imageMap: map,
    hasDrape: texture !== undefined || colors !== undefined,
    ...{origin, positions, toTargets, normals, indices, hasWater, material, mesh},
  };
}

/** Gives the mesh what it morphs to. \pre the parent's content is loaded (none: the root) */
export function completeTargets(content: TileContent, parent: TileContent | undefined): void {
  const {geometry} = content.mesh;
  if (geometry.hasAttribute('targetNormal')) return;
  const targets = parent && targetVertices(content, parent);
  const normals = targets ? targetNormals(content, parent, targets) : content.normals;
  geometry.setAttribute('targetNormal', new BufferAttribute(normals as Int8Array, 3, true));
  if (!geometry.hasAttribute('vertexColor')) return;
  const colors = geometry.getAttribute('vertexColor').array as Uint8Array;
  const above = parent?.mesh.geometry.attributes.vertexColor?.array as Uint8Array | undefined;
  const ends = targets && above ? targetColors(colors, above, targets) : colors;
  geometry.setAttribute('targetColor', new BufferAttribute(ends, 3, true));
}

/** Gives the mesh the image that it blends into: its own where the parent has none. */
export function lendImage(content: TileContent, parent: TileContent | undefined): void {
  const {material} = content;
  const above = parent?.material.uniforms.image!.value as Texture | null | undefined;
  if (parent && above) {
    setParentImage(material, above, mapOfParent(parent.imageMap, parent, content));
  } else if (material.uniforms.image!.value) {
    setParentImage(material, material.uniforms.image!.value as Texture, content.imageMap);
  }
}

const kTriangleColor = new Vector4(0.05, 0.08, 0.12, 0.3);
const kBorderColor = new Vector4(0.08, 0.05, 0.2, 1);

export function triangleLines(content: TileContent): Mesh {
  content.triangleLines ??= fixed(
    new Mesh(content.mesh.geometry, lineMaterial(content.material, kTriangleColor, true)),
  );
  return content.triangleLines;
}

export function borderLines(content: TileContent): LineSegments {
  if (!content.borderLines) {
    const {material} = content;
    const {geometry} = content.mesh;
    const lines = new BufferGeometry();
    for (const name of ['position', 'toTarget'])
      lines.setAttribute(name, geometry.getAttribute(name));
    const {edges} = borderOf(content.indices, content.positions.length / 3);
    lines.setIndex(edges.flat());
    content.borderLines = fixed(
      new LineSegments(lines, lineMaterial(material, kBorderColor, false)),
    );
  }
  return content.borderLines;
}

export function disposeContent(content: TileContent): void {
  const {image} = content.material.uniforms;
  if (image?.value) {
    (image.value.image as ImageBitmap).close();
    image.value.dispose();
  }
  for (const object of [content.mesh, content.triangleLines, content.borderLines]) {
    object?.removeFromParent();
    object?.geometry.dispose();
    for (const material of object ? materialsOf(object) : []) material.dispose();
  }
}

export function materialsOf({material}: Mesh | LineSegments): readonly Material[] {
  return Array.isArray(material) ? (material as Material[]) : [material as Material];
}

/** Its place is in the shader's uniforms, and terrain_view.ts knows whether it is in the picture. */
function fixed<T extends Mesh | LineSegments>(object: T): T {
  object.matrixAutoUpdate = false;
  object.frustumCulled = false;
  object.visible = false;
  return object;
}

function textureOf(image: ImageBitmap): Texture {
  const texture = new Texture(image);
  texture.flipY = false;
  texture.minFilter = LinearMipmapLinearFilter;
  texture.anisotropy = kAnisotropy;
  texture.needsUpdate = true;
  return texture;
}
