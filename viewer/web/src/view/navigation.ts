import {PerspectiveCamera} from 'three';
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

  /** @param onChange called when the user moves the camera */
  constructor(
    canvas: HTMLCanvasElement,
    private readonly box: Box,
    onChange: () => void,
  ) {
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.screenSpacePanning = false;
    this.controls.zoomToCursor = true;
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.15;
    this.controls.maxPolarAngle = 0.495 * Math.PI;
    this.controls.maxDistance = 4 * diagonal(box);
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

  private place({eye, target}: Camera): void {
    this.camera.position.fromArray(eye);
    this.controls.target.fromArray(target);
    this.controls.update();
  }
}
