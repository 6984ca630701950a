import {boundsOf, distanceToBounds, type Bounds, type Box} from '../core/box';
import {firstCamera, type Camera} from '../core/first_camera';
import * as poses from '../core/pose';
import type {Pose} from '../core/pose';
import {add, length, scale, subtract, type Vec3} from '../core/vec3';
import {Gestures, type Moves} from './gestures';
import {kFovDeg} from './terrain_view';

/** What the camera moves over; heights as they are seen. */
export interface Ground {
  /** The terrain at a place of the picture, -1 to 1 to the right and up. */
  readonly pick: (right: number, up: number) => Vec3 | undefined;
  readonly direction: (right: number, up: number) => Vec3;
  readonly heightAt: (x: number, y: number) => number | undefined;
}

/** A step of time, and the keys that are down. */
const kFlightS = 0.9;
const kZoomS = 0.08;
const kGlideS = 0.22;
/** Farther than this, in diagonals of the terrain, is nothing to see. */
const kFarthest = 4;

interface Flight {
  readonly from: Pose;
  readonly to: Pose;
  share: number;
}

/** A camera that mouse, touch and keys move over the terrain, and never below it. */
export class Navigation implements Moves {
  pose: Pose = {eye: [0, 0, 0], headingDeg: 0, pitchDeg: -30};
  isFlying = false;
  private readonly gestures: Gestures;
  private readonly quiet = matchMedia('(prefers-reduced-motion: reduce)');
  private isAtStart = true;
  private aspect = 1;
  private flight: Flight | undefined;
  /** Zoom that is still to come: natural logarithm of the factor, and about what. */
  private zoomLeft = 0;
  private zoomPoint: Vec3 = [0, 0, 0];
  /** The eye's speed while it is dragged and glides on, in metres a second. */
  private speed: Vec3 = [0, 0, 0];
  private lastEye: Vec3 = [0, 0, 0];
  private exaggeration = 1;

  constructor(
    canvas: HTMLCanvasElement,
    private readonly box: Box,
    private readonly clearanceM: number,
    private readonly ground: Ground,
    private readonly onChange: () => void,
  ) {
    this.gestures = new Gestures(canvas, this, onChange);
  }

  /** Takes a picture size; before the user has moved, the whole terrain stays in view. */
  resize(aspect: number): void {
    this.aspect = aspect;
    if (this.isAtStart) this.pose = this.homePose();
  }

  set(pose: Pose): void {
    this.halt();
    this.isAtStart = false;
    this.pose = pose;
  }

  setCamera(camera: Camera): void {
    this.set(poses.poseOf(camera));
  }

  /** Keeps the eye over the same part of a terrain whose heights are drawn differently. */
  setExaggeration(exaggeration: number): void {
    const [x, y, z] = this.pose.eye;
    const ground = this.ground.heightAt(x, y) ?? this.box.center[2] * this.exaggeration;
    const seen = (ground / this.exaggeration) * exaggeration;
    this.pose = {...this.pose, eye: [x, y, z - ground + seen]};
    this.exaggeration = exaggeration;
    if (this.isAtStart) this.pose = this.homePose();
  }

  home(): void {
    this.flyTo(this.homePose());
    this.isAtStart = true;
  }

  /** Turns north up, about the middle of the picture. */
  faceNorth(): void {
    const pivot = this.pivotAt(0, 0);
    this.flyTo(poses.orbit(this.pose, pivot, -this.pose.headingDeg, 0));
  }

  /** Whether the user or an animation has moved away from the first view. */
  get hasMoved(): boolean {
    return !this.isAtStart;
  }

  toggleFlying(): void {
    this.halt();
    this.isFlying = !this.isFlying;
    this.onChange();
  }

  dragFrom(point: Vec3, right: number, up: number): void {
    this.userMoves();
    this.pose = poses.drag(this.pose, point, this.ground.direction(right, up));
  }

  orbit(pivot: Vec3, turnDeg: number, tiltDeg: number): void {
    this.userMoves();
    this.pose = poses.orbit(this.pose, pivot, turnDeg, tiltDeg);
  }

  look(turnDeg: number, tiltDeg: number): void {
    this.userMoves();
    this.pose = poses.look(this.pose, turnDeg, tiltDeg);
  }

  zoomAt(point: Vec3, factor: number): void {
    this.userMoves();
    this.pose = poses.zoom(this.pose, point, factor);
  }

  /** As zoomAt(), over the next frames. */
  zoomSoon(point: Vec3, factor: number): void {
    if (this.quiet.matches) return this.zoomAt(point, factor);
    this.isAtStart = false;
    this.flight = undefined;
    this.zoomLeft += Math.log(factor);
    this.zoomPoint = point;
    this.onChange();
  }

  /** The terrain there; where there is none, a point as far away as the terrain. */
  pivotAt(right: number, up: number): Vec3 {
    const hit = this.ground.pick(right, up);
    if (hit) return hit;
    const direction = this.ground.direction(right, up);
    const toMiddle = subtract(this.seenCenter(), this.pose.eye);
    const awayM = Math.max(this.heightOverGround(), 0.5 * length(toMiddle));
    return add(this.pose.eye, scale(direction, awayM));
  }

  /** Lets the eye glide on after a drag. */
  release(): void {
    if (this.quiet.matches) this.speed = [0, 0, 0];
    this.onChange();
  }

  /**
   * Moves on by one frame.
   *
   * @returns whether the camera is still moving
   */
  step(elapsedS: number): boolean {
    this.stepFlight(elapsedS);
    this.stepZoom(elapsedS);
    this.stepKeys(elapsedS);
    this.stepGlide(elapsedS);
    this.pose = {...this.pose, eye: this.allowed(this.pose.eye)};
    return (
      this.flight !== undefined ||
      this.zoomLeft !== 0 ||
      this.gestures.isHolding ||
      length(this.speed) > 0
    );
  }

  /** Metres of the eye over the ground as it is seen; over the terrain's middle beside it. */
  heightOverGround(): number {
    const [x, y, z] = this.pose.eye;
    return Math.abs(z - (this.ground.heightAt(x, y) ?? this.seenCenter()[2]));
  }

  private flyTo(pose: Pose): void {
    this.halt();
    this.isAtStart = false;
    if (this.quiet.matches) this.pose = pose;
    else this.flight = {from: this.pose, to: pose, share: 0};
    this.onChange();
  }

  private stepFlight(elapsedS: number): void {
    if (!this.flight) return;
    const {from, to} = this.flight;
    this.flight.share = Math.min(1, this.flight.share + elapsedS / kFlightS);
    const t = this.flight.share;
    this.pose = poses.between(from, to, t * t * (3 - 2 * t));
    if (t === 1) this.flight = undefined;
  }

  private stepZoom(elapsedS: number): void {
    if (this.zoomLeft === 0) return;
    const rest = this.zoomLeft * Math.exp(-elapsedS / kZoomS);
    const now = Math.abs(rest) < 0.002 ? this.zoomLeft : this.zoomLeft - rest;
    this.pose = poses.zoom(this.pose, this.zoomPoint, Math.exp(now));
    this.zoomLeft -= now;
  }

  private stepKeys(elapsedS: number): void {
    const {rightward, forward, upward, turn, tilt, zoom} = this.gestures.held;
    if (!this.gestures.hasKeys) return;
    this.userMoves();
    if (this.isFlying) {
      const reachM = Math.max(this.heightOverGround(), 20 * this.clearanceM) * elapsedS;
      this.pose = poses.move(this.pose, rightward * reachM, forward * reachM, upward * reachM);
      this.pose = poses.look(this.pose, 60 * elapsedS * turn, 40 * elapsedS * tilt);
      return;
    }
    const pivot = this.pivotAt(0, 0);
    const reachM = 0.7 * length(subtract(pivot, this.pose.eye)) * elapsedS;
    const flat = {...this.pose, pitchDeg: 0};
    const moved = poses.move(flat, rightward * reachM, forward * reachM, 0);
    this.pose = {...this.pose, eye: moved.eye};
    this.pose = poses.orbit(this.pose, pivot, 60 * elapsedS * turn, 40 * elapsedS * tilt);
    if (zoom !== 0) this.pose = poses.zoom(this.pose, pivot, Math.exp(-1.4 * zoom * elapsedS));
  }

  private stepGlide(elapsedS: number): void {
    if (this.gestures.isDragging) {
      const now = scale(subtract(this.pose.eye, this.lastEye), 1 / Math.max(1e-3, elapsedS));
      this.speed = add(scale(this.speed, 0.5), scale(now, 0.5));
    } else if (length(this.speed) > 0) {
      this.pose = {...this.pose, eye: add(this.pose.eye, scale(this.speed, elapsedS))};
      this.speed = scale(this.speed, Math.exp(-elapsedS / kGlideS));
      if (length(this.speed) < 0.02 * this.heightOverGround()) this.speed = [0, 0, 0];
    }
    this.lastEye = this.pose.eye;
  }

  private userMoves(): void {
    this.isAtStart = false;
    this.flight = undefined;
    this.zoomLeft = 0;
    if (!this.gestures.isDragging) this.speed = [0, 0, 0];
  }

  private halt(): void {
    this.flight = undefined;
    this.zoomLeft = 0;
    this.speed = [0, 0, 0];
  }

  /** Over the ground, and not out of sight of the terrain. */
  private allowed(eye: Vec3): Vec3 {
    const [x, y, z] = eye;
    const ground = this.ground.heightAt(x, y);
    if (ground !== undefined && z < ground + this.clearanceM)
      return [x, y, ground + this.clearanceM];
    const seen = seenBounds(boundsOf(this.box), this.exaggeration);
    const farthestM = kFarthest * length(subtract(seen.high, seen.low));
    const awayM = distanceToBounds(seen, eye);
    if (awayM <= farthestM) return eye;
    const center = this.seenCenter();
    return add(center, scale(subtract(eye, center), farthestM / awayM));
  }

  private homePose(): Pose {
    const center = this.seenCenter();
    const [u, v, w] = this.box.halfAxes.map(([x, y, z]): Vec3 => [x, y, z * this.exaggeration]) as [
      Vec3,
      Vec3,
      Vec3,
    ];
    const seen = {center, halfAxes: [u, v, w]} as const;
    return poses.poseOf(firstCamera(seen, {fovDeg: kFovDeg, aspect: this.aspect}));
  }

  private seenCenter(): Vec3 {
    const [x, y, z] = this.box.center;
    return [x, y, z * this.exaggeration];
  }
}

function seenBounds({low, high}: Bounds, exaggeration: number): Bounds {
  return {
    low: [low[0], low[1], low[2] * exaggeration],
    high: [high[0], high[1], high[2] * exaggeration],
  };
}
