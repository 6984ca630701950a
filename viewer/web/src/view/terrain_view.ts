import {Frustum, Matrix4, PerspectiveCamera, Scene, Vector3, WebGLRenderer} from 'three';
import {corners, distanceToBox, type Box} from '../core/box';
import type {MorphUniforms} from '../core/morph';
import {morphUniforms, renderOrigin} from '../core/render_origin';
import type {DrawnTile} from '../core/seams';
import type {Frame} from '../core/streamer';
import type {Tile, Tileset} from '../core/tileset';
import {length, subtract, type Vec3} from '../core/vec3';
import {setMorph, sharedUniforms, type SharedUniforms} from './terrain_material';
import {completeNormals, type TileContent} from './tile_content';

/** What one picture holds. */
export interface Drawn {
  readonly tiles: number;
  readonly triangles: number;
  /** Tiles in the picture by level. */
  readonly levels: Readonly<Record<number, number>>;
}

/** Nearest and farthest drawn distance are at most this factor apart: 24 bits of depth. */
const kDepthSpan = 50000;

/** Draws cuts of a tileset. */
export class TerrainView {
  readonly shared: SharedUniforms;
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera();
  private originM: Vec3 = [0, 0, 0];
  private wireframe = false;

  constructor(
    canvas: HTMLCanvasElement,
    private readonly tileset: Tileset,
    antialias: boolean,
  ) {
    // clear where nothing is drawn: the page's sky shows through
    this.renderer = new WebGLRenderer({canvas, antialias, alpha: true});
    this.renderer.setClearColor(0, 0);
    this.shared = sharedUniforms(tileset.minHeightM, tileset.maxHeightM, tileset.curved);
  }

  resize(width: number, height: number, pixelRatio: number): void {
    this.renderer.setPixelRatio(pixelRatio);
    this.renderer.setSize(width, height, false);
  }

  setWireframe(on: boolean): void {
    this.wireframe = on;
  }

  setLevelColors(on: boolean): void {
    this.shared.levelColors.value = on ? 1 : 0;
  }

  /**
   * Takes over a camera.
   *
   * @param clearanceM metres from the eye down to the ground
   */
  aim(world: PerspectiveCamera, clearanceM: number): void {
    const eye = world.position.toArray() as unknown as Vec3;
    const {root, levels} = this.tileset;
    this.originM = renderOrigin(eye, levels[levels.length - 1]!.stepM);
    this.camera.copy(world, false);
    this.camera.position.fromArray(subtract(eye, this.originM));
    this.camera.far = 1.01 * Math.max(...corners(root.box).map((c) => length(subtract(c, eye))));
    const nearest = Math.max(distanceToBox(root.box, eye), clearanceM / 4);
    const smallest = this.camera.far / kDepthSpan;
    this.camera.near = Math.min(0.9 * this.camera.far, Math.max(0.9 * nearest, smallest));
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld(true);
    this.shared.eyeM.value.copy(this.camera.position);
    this.shared.originM.value.fromArray(this.originM);
  }

  /** A test whether a box may be in the picture of the camera last aimed with. */
  pictureTest(): (box: Box) => boolean {
    const matrix = new Matrix4().multiplyMatrices(
      this.camera.projectionMatrix,
      this.camera.matrixWorldInverse,
    );
    const {planes} = new Frustum().setFromProjectionMatrix(matrix);
    return (box) => planes.every((plane) => reaches(box, this.originM, plane));
  }

  /** Draws the tiles of a frame that are in the picture. */
  draw(frame: Frame, contentOf: (tile: Tile) => TileContent): Drawn {
    for (const object of this.scene.children) object.visible = false;
    const isInPicture = this.pictureTest();
    const levels: Record<number, number> = {};
    let [tiles, triangles] = [0, 0];
    for (const tile of frame.cut) {
      if (!isInPicture(tile.box)) continue;
      const content = contentOf(tile);
      completeNormals(content, tile.parent ? contentOf(tile.parent) : undefined);
      this.show(content, this.uniformsOf(tile, content, frame));
      ++tiles;
      triangles += content.triangles;
      levels[tile.level] = (levels[tile.level] ?? 0) + 1;
    }
    this.renderer.render(this.scene, this.camera);
    return {tiles, triangles, levels};
  }

  /** A tile as the last frame drew it, for checkSeams(). */
  drawnTile(tile: Tile, content: TileContent, frame: Frame): DrawnTile {
    const {level, x, y} = tile;
    const {positions, toTargets, indices} = content;
    const uniforms = this.uniformsOf(tile, content, frame);
    return {level, x, y, positions, toTargets, indices, uniforms};
  }

  private uniformsOf(tile: Tile, content: TileContent, frame: Frame): MorphUniforms {
    const place = {level: tile.level, origin: content.origin, stepM: content.stepM};
    const eyeM = this.camera.position.toArray() as unknown as Vec3;
    return morphUniforms(place, frame.ranges, eyeM, this.originM);
  }

  private show(content: TileContent, uniforms: MorphUniforms): void {
    const {mesh} = content;
    if (!mesh.parent) this.scene.add(mesh);
    mesh.visible = true;
    mesh.material.wireframe = this.wireframe;
    setMorph(mesh.material, uniforms);
  }
}

/** Whether a box, seen from the render origin, is not all behind a plane. */
function reaches(box: Box, originM: Vec3, plane: {normal: Vector3; constant: number}): boolean {
  const along = (v: Vec3) => plane.normal.x * v[0] + plane.normal.y * v[1] + plane.normal.z * v[2];
  const reach = box.halfAxes.reduce((sum, axis) => sum + Math.abs(along(axis)), 0);
  return along(subtract(box.center, originM)) + plane.constant >= -reach;
}
