import {
  Frustum,
  Matrix4,
  PerspectiveCamera,
  Scene,
  Vector3,
  WebGLRenderer,
  type Object3D,
} from 'three';
import {corners, distanceToBox, type Box} from '../core/box';
import type {HoldbackUniform, MorphUniforms} from '../core/morph';
import {forward, type Pose} from '../core/pose';
import {holdbackUniform, morphUniforms, renderOrigin} from '../core/render_origin';
import type {Frame} from '../core/streamer';
import type {ShownTile} from '../core/surface';
import type {Tile, Tileset} from '../core/tileset';
import {add, length, subtract, type Vec3} from '../core/vec3';
import {Sky} from './sky';
import {setHoldbacks, setMorph, sharedUniforms, type SharedUniforms} from './terrain_material';
import {
  borderLines,
  completeTargets,
  lendImage,
  materialsOf,
  triangleLines,
  type TileContent,
} from './tile_content';

/** What one picture holds. */
export interface Drawn {
  readonly tiles: number;
  readonly triangles: number;
  /** Tiles in the picture by level. */
  readonly levels: Readonly<Record<number, number>>;
}

/** Lines over the terrain. */
export interface Overlays {
  readonly triangles: boolean;
  readonly borders: boolean;
}

export const kFovDeg = 45;

/** Nearest and farthest drawn distance are at most this factor apart: 24 bits of depth. */
const kDepthSpan = 50000;

/** Draws cuts of a tileset. */
export class TerrainView {
  readonly shared: SharedUniforms;
  overlays: Overlays = {triangles: false, borders: false};
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(kFovDeg);
  private readonly sky: Sky;
  private originM: Vec3 = [0, 0, 0];
  private holdbacks: readonly HoldbackUniform[] = [];

  constructor(
    canvas: HTMLCanvasElement,
    private readonly tileset: Tileset,
    antialias: boolean,
  ) {
    this.renderer = new WebGLRenderer({canvas, antialias, alpha: true});
    this.renderer.setClearColor(0, 0);
    this.shared = sharedUniforms(tileset);
    this.sky = new Sky(this.shared);
    this.scene.add(this.sky.mesh);
    this.camera.up.set(0, 0, 1);
  }

  resize(width: number, height: number, pixelRatio: number): void {
    this.renderer.setPixelRatio(pixelRatio);
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
  }

  /** Draws a colour instead of the sky, so that tests see through cracks; null: the sky. */
  setBackdrop(color: number | null): void {
    this.sky.mesh.visible = color === null;
    this.renderer.setClearColor(color ?? 0, color === null ? 0 : 1);
  }

  /**
   * Takes over a camera.
   *
   * @param pose where the eye stands in the world as it is seen: z times the exaggeration
   * @param clearanceM metres from the eye down to the ground
   */
  aim(pose: Pose, exaggeration: number, clearanceM: number): void {
    const {root, levels} = this.tileset;
    const seen = (z: number) => z * exaggeration;
    const eye: Vec3 = [pose.eye[0], pose.eye[1], pose.eye[2] / exaggeration];
    this.originM = renderOrigin(eye, levels[levels.length - 1]!.stepM);
    const [ox, oy, oz] = this.originM;
    const place = subtract(pose.eye, [ox, oy, seen(oz)]);
    this.camera.position.fromArray(place);
    this.camera.lookAt(new Vector3().fromArray(add(place, forward(pose))));
    const toCorner = ([x, y, z]: Vec3) => length(subtract([x, y, seen(z)], pose.eye));
    this.camera.far = 1.01 * Math.max(...corners(root.box).map(toCorner));
    const away = distanceToBox(root.box, eye) * Math.min(1, exaggeration);
    const nearest = Math.max(away, clearanceM / 4);
    const smallest = this.camera.far / kDepthSpan;
    this.camera.near = Math.min(0.9 * this.camera.far, Math.max(0.9 * nearest, smallest));
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld(true);
    this.sky.aim(this.camera);
    this.shared.originM.value.fromArray(this.originM);
    this.shared.exaggeration.value = exaggeration;
  }

  /** Direction of a place of the picture, from -1 to 1 to the right and up; in the seen world. */
  directionTo(right: number, up: number): Vec3 {
    const point = new Vector3(right, up, 0.5).unproject(this.camera).sub(this.camera.position);
    return point.normalize().toArray() as unknown as Vec3;
  }

  /** Where a world place is in the picture, -1 to 1; undefined behind the eye. */
  screenOf([x, y, z]: Vec3): {right: number; up: number} | undefined {
    const [ox, oy, oz] = this.originM;
    const point = new Vector3(x - ox, y - oy, (z - oz) * this.shared.exaggeration.value);
    point.project(this.camera);
    return point.z < 1 ? {right: point.x, up: point.y} : undefined;
  }

  /** A test whether a box may be in the picture of the camera last aimed with. */
  pictureTest(): (box: Box) => boolean {
    const matrix = new Matrix4().multiplyMatrices(
      this.camera.projectionMatrix,
      this.camera.matrixWorldInverse,
    );
    const {planes} = new Frustum().setFromProjectionMatrix(matrix);
    const exaggeration = this.shared.exaggeration.value;
    return (box) => planes.every((plane) => reaches(box, this.originM, exaggeration, plane));
  }

  /** Draws the tiles of a frame that are in the picture. */
  draw(frame: Frame, contentOf: (tile: Tile) => TileContent): Drawn {
    for (const object of this.scene.children) {
      if (object !== this.sky.mesh) object.visible = false;
    }
    this.shared.eyeM.value.fromArray(subtract(frame.eye, this.originM));
    this.holdbacks = frame.holdbacks.map((hold) => holdbackUniform(hold, this.originM));
    setHoldbacks(this.shared, this.holdbacks);
    const isInPicture = this.pictureTest();
    const levels: Record<number, number> = {};
    let [tiles, triangles] = [0, 0];
    for (const tile of nearestFirst(frame.cut.filter(({box}) => isInPicture(box)), frame.eye)) {
      const content = contentOf(tile);
      const parent = tile.parent ? contentOf(tile.parent) : undefined;
      completeTargets(content, parent);
      if (content.hasDrape) lendImage(content, parent);
      this.show(content, tiles, this.uniformsOf(tile, content, frame));
      ++tiles;
      triangles += content.triangles;
      levels[tile.level] = (levels[tile.level] ?? 0) + 1;
    }
    this.renderer.render(this.scene, this.camera);
    return {tiles, triangles, levels};
  }

  /** Where the last picture was drawn from. */
  get renderOrigin(): Vec3 {
    return this.originM;
  }

  /** A tile as the last frame drew it. */
  shownTile(tile: Tile, content: TileContent, frame: Frame): ShownTile {
    const {positions, toTargets, indices} = content;
    return {tile, positions, toTargets, indices, uniforms: this.uniformsOf(tile, content, frame)};
  }

  private uniformsOf(tile: Tile, content: TileContent, frame: Frame): MorphUniforms {
    const {level} = tile;
    const {morphShare} = this.tileset.levels[level]!;
    const place = {level, origin: content.origin, stepM: content.stepM, morphShare};
    const eyeM = subtract(frame.eye, this.originM);
    return morphUniforms(place, frame.ranges, eyeM, this.originM, this.holdbacks);
  }

  private show(content: TileContent, order: number, uniforms: MorphUniforms): void {
    const shown: Object3D[] = [content.mesh];
    if (this.overlays.triangles) shown.push(triangleLines(content));
    if (this.overlays.borders) shown.push(borderLines(content));
    for (const object of shown) {
      if (!object.parent) this.scene.add(object);
      object.visible = true;
    }
    content.mesh.renderOrder = order;
    for (const material of materialsOf(content.mesh)) material.polygonOffset = shown.length > 1;
    setMorph(content.material, uniforms);
  }
}

/** Fewer pixels are shaded that others hide. */
function nearestFirst(tiles: readonly Tile[], eye: Vec3): Tile[] {
  return tiles
    .map((tile) => ({tile, awayM: distanceToBox(tile.box, eye)}))
    .sort((a, b) => a.awayM - b.awayM)
    .map(({tile}) => tile);
}

/** Whether a box, seen from the render origin, is not all behind a plane. */
function reaches(
  box: Box,
  originM: Vec3,
  exaggeration: number,
  {normal, constant}: {normal: Vector3; constant: number},
): boolean {
  const along = (v: Vec3) => normal.x * v[0] + normal.y * v[1] + normal.z * v[2] * exaggeration;
  const reach = box.halfAxes.reduce((sum, axis) => sum + Math.abs(along(axis)), 0);
  return along(subtract(box.center, originM)) + constant >= -reach;
}
