import {PerspectiveCamera, Vector3} from 'three';
import {OrbitControls} from 'three/examples/jsm/controls/OrbitControls.js';
import {diagonal, type Box} from '../core/box';
import {firstCamera, type Camera} from '../core/first_camera';
import type {Vec3} from '../core/vec3';

const kFovDeg = 45;

/** A camera in world metres (z up) that mouse and touch orbit, move and zoom. */
export class Navigation {
  readonly camera = new PerspectiveCamera(kFovDeg);
  private readonly controls: OrbitControls;
  private isAtStart = true;

  /**
   * @param hit metres from the eye to the terrain in a direction; undefined where there is none
   * @param onChange called when the user moves the camera
   */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly box: Box,
    private readonly hit: (direction: Vec3) => number | undefined,
    onChange: () => void,
  ) {
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.zoomToCursor = true;
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.15;
    this.controls.maxPolarAngle = 0.495 * Math.PI;
    this.controls.maxDistance = 4 * diagonal(box);
    this.controls.minDistance = 1e-4 * diagonal(box);
    this.followGround();
    this.controls.addEventListener('start', () => (this.isAtStart = false));
    this.controls.addEventListener('change', onChange);
  }

  get eye(): Vec3 {
    return this.camera.position.toArray() as unknown as Vec3;
  }

  /** Takes a picture size; before the user has moved, the whole terrain stays in view. */
  resize(aspect: number): void {
    this.camera.aspect = aspect;
    if (this.isAtStart) this.place(firstCamera(this.box, {fovDeg: kFovDeg, aspect}));
  }

  set(camera: Camera): void {
    this.isAtStart = false;
    this.place(camera);
  }

  /**
   * Moves on by one frame.
   *
   * @param lowestZ the eye is lifted to this world z if it is lower
   * @returns whether the camera is still moving
   */
  step(lowestZ: number): boolean {
    const moved = this.controls.update();
    if (this.camera.position.z < lowestZ) {
      this.camera.position.z = lowestZ;
      this.camera.lookAt(this.controls.target);
    }
    return moved;
  }

  /**
   * Before the controls see an input, puts what they turn about and zoom to onto the terrain: in
   * the middle of the picture for a drag, under the cursor for the wheel.
   */
  private followGround(): void {
    const first = {capture: true};
    this.canvas.addEventListener('pointerdown', () => this.focus(0, 0, false), first);
    const onWheel = ({offsetX, offsetY}: WheelEvent) => {
      const {clientWidth, clientHeight} = this.canvas;
      this.focus((2 * offsetX) / clientWidth - 1, 1 - (2 * offsetY) / clientHeight, true);
    };
    this.canvas.addEventListener('wheel', onWheel, first);
  }

  /** @param isZoom the controls then keep the direction of view; else they move over the ground */
  private focus(screenX: number, screenY: number, isZoom: boolean): void {
    this.controls.screenSpacePanning = isZoom;
    this.camera.updateMatrixWorld();
    const point = new Vector3(screenX, screenY, 0.5).unproject(this.camera);
    const direction = point.sub(this.camera.position).normalize();
    const distanceM = this.hit(direction.toArray() as unknown as Vec3);
    if (distanceM === undefined) return;
    const forward = this.camera.getWorldDirection(new Vector3());
    this.controls.target.copy(this.camera.position).addScaledVector(forward, distanceM);
  }

  private place({eye, target}: Camera): void {
    this.camera.position.fromArray(eye);
    this.controls.target.fromArray(target);
    this.controls.update();
  }
}
