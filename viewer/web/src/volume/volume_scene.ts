import {
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  DirectionalLight,
  DoubleSide,
  EdgesGeometry,
  Group,
  HemisphereLight,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshLambertMaterial,
  Plane as ClippingPlane,
  Scene,
  Vector3,
} from 'three';
import {cutCells, valuesAt, zeroSet, type Cut, type Plane} from './cut_cells';
import {kMostMaterials, kMostSurfaces, kMostValues, materialColor, sectionMaterial} from './section_material';
import type {VolumeData} from './volume_data';

/** What a cut has in it. */
export interface CutStats {
  cells: number;
  triangles: number;
}

/** Four values a corner each, of at most eight: what does not exist is 1 (above every surface). */
function fourOf(cut: Cut, values: Float32Array, stride: number, first: number, most: number) {
  const count = Math.max(0, Math.min(4, most));
  if (count === 0) return new BufferAttribute(new Float32Array(4 * cut.from.length).fill(1), 4);
  const four = valuesAt(cut, values, {stride, first, count, width: 4});
  for (let i = 0; i < cut.from.length; ++i) four.fill(1, 4 * i + count, 4 * i + 4);
  return new BufferAttribute(four, 4);
}

/** A volume in metres from the middle of its box, z up: its section, its mesh, its surfaces. */
export class VolumeScene {
  readonly scene = new Scene();
  private readonly group = new Group();
  private readonly section: Mesh<BufferGeometry, ReturnType<typeof sectionMaterial>>;
  private readonly sides: LineSegments;
  private readonly surfaces = new Group();
  private readonly clip = new ClippingPlane();
  private field = -1;
  private plane: Plane = {normal: [0, 1, 0], offset: 0};

  /** @throws Error if there are more surfaces or materials than can be shown. */
  constructor(private readonly data: VolumeData) {
    if (data.surfaces.length > kMostSurfaces || data.materials.length > kMostMaterials) {
      throw new Error(`more than ${kMostSurfaces} surfaces or ${kMostMaterials} materials`);
    }
    this.section = new Mesh(new BufferGeometry(), sectionMaterial(data));
    const ink = new LineBasicMaterial({color: 0x10181f, transparent: true, opacity: 0.55});
    this.sides = new LineSegments(new BufferGeometry(), ink);
    // neither has a size that is known ahead
    this.section.frustumCulled = this.sides.frustumCulled = false;
    this.sides.renderOrder = 1;
    this.addSurfaces();
    const [x, y, z] = data.halfSize;
    const frame = new EdgesGeometry(new BoxGeometry(2 * x, 2 * y, 2 * z));
    this.group.add(this.section, this.sides, this.surfaces);
    this.group.add(new LineSegments(frame, new LineBasicMaterial({color: 0x8d99a3})));
    const sun = new DirectionalLight(0xffffff, 1.6);
    sun.position.set(-1, 0.6, 1.2);
    this.scene.add(this.group, sun, new HemisphereLight(0xffffff, 0xb0a898, 1.9));
  }

  private addSurfaces(): void {
    const {data} = this;
    data.surfaces.forEach((_, surface) => {
      const cut = zeroSet(data.distances, surface, data.surfaces.length, data.corners, data.parting);
      const places = {stride: 3, first: 0, count: 3, width: 3};
      const geometry = new BufferGeometry();
      geometry.setAttribute('position', new BufferAttribute(valuesAt(cut, data.positions, places), 3));
      geometry.setIndex(new BufferAttribute(cut.triangles, 1));
      const under = data.materials.findIndex(({below}) => below & (1 << surface));
      const material = new MeshLambertMaterial({
        color: materialColor(Math.max(0, under)),
        flatShading: true,
        side: DoubleSide,
        clippingPlanes: [this.clip],
      });
      this.surfaces.add(new Mesh(geometry, material));
    });
  }

  /** Moves the section; only the eye's far side of the surfaces stays, see look(). */
  cut(plane: Plane): CutStats {
    const {data} = this;
    this.plane = plane;
    const cut = cutCells(data.positions, data.corners, plane);
    const geometry = new BufferGeometry();
    const places = {stride: 3, first: 0, count: 3, width: 3};
    const position = new BufferAttribute(valuesAt(cut, data.positions, places), 3);
    geometry.setAttribute('position', position);
    const count = data.surfaces.length;
    geometry.setAttribute('distances0', fourOf(cut, data.distances, count, 0, count));
    geometry.setAttribute('distances1', fourOf(cut, data.distances, count, 4, count - 4));
    const materials = data.materials.length;
    const [stride, first] = [data.fields.length * materials, Math.max(0, this.field) * materials];
    const shown = this.field < 0 ? 0 : Math.min(materials, kMostValues);
    geometry.setAttribute('values0', fourOf(cut, data.values, stride, first, shown));
    geometry.setAttribute('values1', fourOf(cut, data.values, stride, first + 4, shown - 4));
    geometry.setIndex(new BufferAttribute(cut.triangles, 1));
    const lines = new BufferGeometry();
    lines.setAttribute('position', position);
    lines.setIndex(new BufferAttribute(cut.sides, 1));
    this.section.geometry.dispose();
    this.sides.geometry.dispose();
    this.section.geometry = geometry;
    this.sides.geometry = lines;
    return {cells: cut.cells, triangles: cut.triangles.length / 3};
  }

  /** Takes away what lies between the eye and the section. To be called before each picture. */
  look(eye: Vector3): void {
    const {normal, offset} = this.plane;
    const stretch = this.group.scale.z;
    const n = new Vector3(normal[0], normal[1], normal[2] / stretch);
    const length = n.length();
    n.divideScalar(length);
    const side = n.dot(eye) - offset / length > 0 ? 1 : -1;
    this.clip.set(n.multiplyScalar(-side), (side * offset) / length);
  }

  /** Colours by a field, or by material (-1). */
  colour(field: number): CutStats {
    this.field = field;
    const {uniforms} = this.section.material;
    uniforms.showsField.value = field >= 0;
    if (field >= 0) uniforms.range.value.fromArray(this.data.fields[field].range);
    return this.cut(this.plane);
  }

  set showsMesh(shows: boolean) {
    this.sides.visible = shows;
  }

  set showsSurfaces(shows: boolean) {
    this.surfaces.visible = shows;
  }

  /** Draws heights so many times as high. */
  set stretch(stretch: number) {
    this.group.scale.z = stretch;
  }

  /** Where a place of the model (from the middle of the box) stands in the scene. */
  toScene([x, y, z]: readonly number[]): Vector3 {
    return new Vector3(x, y, z * this.group.scale.z);
  }
}
