import {BufferAttribute, BufferGeometry, Mesh, type ShaderMaterial} from 'three';
import type {InterleavedBufferAttribute} from 'three';
import {GLTFLoader} from 'three/examples/jsm/loaders/GLTFLoader.js';
import {MeshoptDecoder} from 'three/examples/jsm/libs/meshopt_decoder.module.js';
import {targetNormals, type TileVertices} from '../core/target_normals';
import type {Level, Tile} from '../core/tileset';
import type {Vec3} from '../core/vec3';
import {terrainMaterial, type SharedUniforms} from './terrain_material';

/** Whole numbers: 16 bits where they fit, else floats. */
type Steps = Int16Array | Float32Array;

/** A tile that is loaded: its integers, and the mesh to draw. */
export interface TileContent extends TileVertices {
  readonly bytes: number;
  readonly triangles: number;
  readonly positions: Steps;
  readonly toTargets: Steps;
  readonly normals: Int8Array;
  readonly indices: Uint16Array | Uint32Array;
  readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;
}

/** Fetches and decodes tiles. */
export class TileLoader {
  private readonly gltf = new GLTFLoader().setMeshoptDecoder(MeshoptDecoder);

  constructor(
    private readonly levels: readonly Level[],
    private readonly shared: SharedUniforms,
  ) {}

  /** Rejects with a message that names the tile's address and what is wrong with it. */
  async load(tile: Tile, signal: AbortSignal): Promise<TileContent> {
    const response = await fetch(tile.url, {signal});
    if (!response.ok) throw new Error(`${tile.url}: status ${response.status}`);
    const {scene} = await this.gltf.parseAsync(await response.arrayBuffer(), '');
    const source = scene.getObjectByProperty('isMesh', true) as Mesh | undefined;
    const origin = source?.userData?.terrane?.origin as Vec3 | undefined;
    if (!source || !origin) throw new Error(`${tile.url}: no mesh with extras.terrane.origin`);
    return this.content(tile, source.geometry, origin);
  }

  private content(tile: Tile, source: BufferGeometry, origin: Vec3): TileContent {
    const attribute = (name: string) => {
      const found = source.getAttribute(name);
      if (!found) throw new Error(`${tile.url}: no attribute ${name}`);
      return found;
    };
    const positions = steps(attribute('position'));
    const toTargets = steps(attribute('_morph'));
    const normals = triples(attribute('normal'), new Int8Array(3 * attribute('normal').count));
    const indices = source.index!.array as Uint16Array | Uint32Array;
    const mesh = this.mesh(tile, positions, toTargets, normals, indices);
    // what the arrays take here and on the card, target normals included
    const bytes = 2 * (2 * positions.byteLength + 2 * normals.byteLength + indices.byteLength);
    const stepM = this.levels[tile.level]!.stepM;
    const triangles = indices.length / 3;
    return {bytes, triangles, origin, stepM, positions, toTargets, normals, indices, mesh};
  }

  private mesh(
    tile: Tile,
    positions: Steps,
    toTargets: Steps,
    normals: Int8Array,
    indices: Uint16Array | Uint32Array,
  ) {
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(positions, 3));
    geometry.setAttribute('toTarget', new BufferAttribute(toTargets, 3));
    geometry.setAttribute('normal', new BufferAttribute(normals, 3, true));
    geometry.setIndex(new BufferAttribute(indices, 1));
    const mesh = new Mesh(geometry, terrainMaterial(this.shared, tile.level));
    // its place is in the shader's uniforms, and terrain_view.ts knows whether it is in the picture
    mesh.matrixAutoUpdate = false;
    mesh.frustumCulled = false;
    mesh.visible = false;
    return mesh;
  }
}

/** Gives the mesh the normals it morphs to. \pre the parent's content is loaded (none: the root) */
export function completeNormals(content: TileContent, parent: TileContent | undefined): void {
  const {geometry} = content.mesh;
  if (geometry.hasAttribute('targetNormal')) return;
  const normals = parent ? targetNormals(content, parent) : content.normals;
  geometry.setAttribute('targetNormal', new BufferAttribute(normals, 3, true));
}

export function disposeContent(content: TileContent): void {
  content.mesh.removeFromParent();
  content.mesh.geometry.dispose();
  content.mesh.material.dispose();
}

function steps(attribute: BufferAttribute | InterleavedBufferAttribute): Steps {
  const stored = 'data' in attribute ? attribute.data.array : attribute.array;
  const size = 3 * attribute.count;
  return triples(
    attribute,
    stored instanceof Int16Array ? new Int16Array(size) : new Float32Array(size),
  );
}

/** Copies the stored numbers of an attribute of three components, without gaps. */
function triples<T extends Int8Array | Int16Array | Float32Array>(
  attribute: BufferAttribute | InterleavedBufferAttribute,
  packed: T,
): T {
  const interleaved = 'data' in attribute;
  const stored = interleaved ? attribute.data.array : attribute.array;
  const stride = interleaved ? attribute.data.stride : attribute.itemSize;
  const offset = interleaved ? attribute.offset : 0;
  for (let i = 0; i < attribute.count; ++i) {
    for (let k = 0; k < 3; ++k) packed[3 * i + k] = stored[i * stride + offset + k]!;
  }
  return packed;
}
