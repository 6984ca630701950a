import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DoubleSide,
  LineSegments,
  Mesh,
  Scene,
  ShaderMaterial,
  Vector3,
  type Camera,
} from 'three';
import {length, subtract, type Vec3} from '../core/vec3';
import {GrowingAttribute, type Runs} from './growing_attribute';
import {kShininess} from './tree_settings';
import type {ViewEngine} from './view_engine';

const kVertex = /* glsl */ `
  attribute vec4 tint;
  uniform float hasTint;
  varying vec3 vNormal;
  varying vec3 vToEye;
  varying vec3 vBase;
  void main() {
    vBase = mix(vec3(0.72, 0.68, 0.62), tint.rgb, hasTint);
    vNormal = normal;
    vToEye = cameraPosition - position;
    gl_Position = projectionMatrix * viewMatrix * vec4(position, 1.0);
  }`;

// the highlight is the one that the engine's criterion is about: (N . H)^s
const kFragment = /* glsl */ `
  uniform vec3 toLight;
  varying vec3 vNormal;
  varying vec3 vToEye;
  varying vec3 vBase;
  void main() {
    vec3 n = normalize(vNormal);
    vec3 base = gl_FrontFacing ? vBase : vec3(0.55, 0.42, 0.38);
    float lit = dot(n, toLight);
    vec3 color = base * (0.34 + 0.14 * n.z + 0.62 * max(lit, 0.0));
    vec3 h = normalize(normalize(vToEye) + toLight);
    float shine = lit > 0.0 ? pow(max(dot(n, h), 0.0), ${kShininess.toFixed(1)}) : 0.0;
    gl_FragColor = vec4(color + 0.4 * shine, 1.0);
  }`;

function lines(color: number, opacity: number): ShaderMaterial {
  return new ShaderMaterial({
    uniforms: {color: {value: new Color(color)}, opacity: {value: opacity}},
    vertexShader: 'void main() { gl_Position = projectionMatrix * viewMatrix * vec4(position, 1.0); }',
    fragmentShader:
      'uniform vec3 color; uniform float opacity; void main() { gl_FragColor = vec4(color, opacity); }',
    transparent: opacity < 1,
    depthWrite: false,
  });
}

/** The mesh that an engine shows, relative to its tree's origin, as the graphics card has it. */
export class TreeScene {
  readonly scene = new Scene();
  /** Sent to the graphics card for the last frame. */
  uploadedBytes = 0;
  triangles = 0;

  private readonly geometry = new BufferGeometry();
  private readonly edges = new BufferGeometry();
  private readonly indices = new GrowingAttribute((n) => new Uint32Array(n), 1);
  private readonly lineIndices = new GrowingAttribute((n) => new Uint32Array(n), 1);
  private readonly positions = new GrowingAttribute((n) => new Float32Array(n), 3);
  private readonly normals = new GrowingAttribute((n) => new Float32Array(n), 3);
  private readonly tints = new GrowingAttribute((n) => new Uint8Array(n), 4, true);
  private readonly surface: Mesh<BufferGeometry, ShaderMaterial>;
  private readonly wires: LineSegments;
  private readonly eyeLines = new LineSegments(new BufferGeometry(), lines(0xb3441c, 1));

  constructor(private readonly hasColours: boolean) {
    const material = new ShaderMaterial({
      uniforms: {toLight: {value: new Vector3(0, 0, 1)}, hasTint: {value: Number(hasColours)}},
      vertexShader: kVertex,
      fragmentShader: kFragment,
      side: DoubleSide,
      // edges lie in front of what they bound
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 1,
    });
    this.surface = new Mesh(this.geometry, material);
    this.wires = new LineSegments(this.edges, lines(0x18222b, 0.55));
    this.wires.visible = this.eyeLines.visible = false;
    for (const object of [this.surface, this.wires, this.eyeLines]) object.frustumCulled = false;
    this.scene.add(this.surface, this.wires, this.eyeLines);
  }

  set toLight(direction: Vec3) {
    (this.surface.material.uniforms.toLight!.value as Vector3).fromArray(direction);
  }

  /** Takes over what an update of the engine has written. */
  follow(engine: ViewEngine, triangles: number): void {
    const indices = engine.indices(triangles);
    const slots = engine.slotCount;
    if (this.reserve(3 * triangles, 3 * slots)) {
      this.take(engine, indices, [0, triangles], [0, slots]);
    } else {
      this.take(engine, indices, engine.changedTriangles(), engine.changedSlots());
    }
    this.triangles = triangles;
    this.geometry.setDrawRange(0, 3 * triangles);
    this.edges.setDrawRange(0, 6 * triangles);
  }

  /** New buffers where the old ones are too small. */
  private reserve(corners: number, coordinates: number): boolean {
    const grown = [
      this.indices.reserve(corners),
      this.positions.reserve(coordinates),
      this.normals.reserve(coordinates),
      this.hasColours && this.tints.reserve((4 * coordinates) / 3),
    ];
    if (!grown.includes(true)) return false;
    // lets go of the old buffers
    this.geometry.dispose();
    this.edges.dispose();
    this.geometry.setIndex(this.indices.attribute);
    this.geometry.setAttribute('position', this.positions.attribute);
    this.geometry.setAttribute('normal', this.normals.attribute);
    if (this.hasColours) this.geometry.setAttribute('tint', this.tints.attribute);
    this.edges.setAttribute('position', this.positions.attribute);
    return true;
  }

  private take(engine: ViewEngine, indices: Uint32Array, triangles: Runs, slots: Runs): void {
    this.indices.take(indices, triangles, 3);
    this.positions.take(engine.positions(), slots, 3);
    this.normals.take(engine.normals(), slots, 3);
    this.uploadedBytes =
      this.indices.changedBytes + this.positions.changedBytes + this.normals.changedBytes;
    if (this.hasColours) {
      this.tints.take(engine.colours(), slots, 4);
      this.uploadedBytes += this.tints.changedBytes;
    }
    if (this.wires.visible) this.takeLines(triangles);
  }

  private takeLines(runs: Runs): void {
    const corners = this.indices.attribute.array;
    if (this.lineIndices.reserve(2 * corners.length)) {
      this.edges.dispose();
      this.edges.setIndex(this.lineIndices.attribute);
      runs = [0, corners.length / 3];
    }
    const ends = this.lineIndices.attribute.array;
    this.lineIndices.write(runs, 6, (begin, end) => {
      for (let at = begin; at < end; at += 6) {
        const [a, b, c] = [corners[at / 2]!, corners[at / 2 + 1]!, corners[at / 2 + 2]!];
        ends[at] = ends[at + 5] = a;
        ends[at + 1] = ends[at + 2] = b;
        ends[at + 3] = ends[at + 4] = c;
      }
    });
    this.uploadedBytes += this.lineIndices.changedBytes;
  }

  set wireframe(shows: boolean) {
    const comes = shows && !this.wires.visible;
    this.wires.visible = shows;
    if (comes) this.takeLines([0, this.triangles]);
  }

  /** Draws where a camera is that looks so far; nothing: takes it away. */
  showEye(camera: Camera | undefined, reach: number): void {
    this.eyeLines.visible = camera !== undefined;
    if (!camera) return;
    const eye = camera.position.toArray() as unknown as Vec3;
    const corners = [
      [-1, -1],
      [1, -1],
      [1, 1],
      [-1, 1],
    ].map(([x, y]) => {
      const away = new Vector3(x, y, 0.5).unproject(camera).toArray() as unknown as Vec3;
      const step = subtract(away, eye);
      const factor = reach / length(step);
      return [0, 1, 2].map((k) => eye[k]! + factor * step[k]!);
    });
    const places = corners.flatMap((corner, k) => [
      ...eye,
      ...corner,
      ...corner,
      ...corners[(k + 1) % 4]!,
    ]);
    this.eyeLines.geometry.setAttribute(
      'position',
      new BufferAttribute(new Float32Array(places), 3),
    );
  }

  /** Places of the corners that show, nine numbers a triangle, from what the card was sent. */
  cornersShown(): number[] {
    const [indices, positions] = [this.indices.attribute.array, this.positions.attribute.array];
    const places: number[] = [];
    for (let i = 0; i < 3 * this.triangles; ++i) {
      const at = 3 * indices[i]!;
      places.push(positions[at]!, positions[at + 1]!, positions[at + 2]!);
    }
    return places;
  }
}
