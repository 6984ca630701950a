import type {Vec3} from '../core/vec3';

/** What gestures can do; places of the picture are from -1 to 1 to the right and up. */
export interface Moves {
  readonly isFlying: boolean;
  pivotAt(right: number, up: number): Vec3;
  /** Moves so that a point lies at a place of the picture. */
  dragFrom(point: Vec3, right: number, up: number): void;
  orbit(pivot: Vec3, turnDeg: number, tiltDeg: number): void;
  look(turnDeg: number, tiltDeg: number): void;
  zoomAt(point: Vec3, factor: number): void;
  zoomSoon(point: Vec3, factor: number): void;
  release(): void;
  home(): void;
  faceNorth(): void;
  toggleFlying(): void;
}

/** Directions that keys hold, each -1, 0 or 1. */
export interface Held {
  readonly rightward: number;
  readonly forward: number;
  readonly upward: number;
  readonly turn: number;
  readonly tilt: number;
  readonly zoom: number;
}

interface Point {
  readonly x: number;
  readonly y: number;
}

const kDegPerPx = 0.25;
const kWheelPerPx = 0.0016;
const kPxPerLine = 18;
/** Fingers that moved this far say what they mean. */
const kDecidedPx = 12;

/** Turns what mouse, fingers and keys do over the canvas into moves of the camera. */
export class Gestures {
  private readonly pointers = new Map<number, Point>();
  private readonly keys = new Set<string>();
  private drag: {pivot: Vec3; turns: boolean} | undefined;
  private pinch: Pinch | undefined;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly moves: Moves,
    private readonly onChange: () => void,
  ) {
    canvas.addEventListener('pointerdown', (event) => this.onDown(event));
    canvas.addEventListener('pointermove', (event) => this.onMove(event));
    for (const name of ['pointerup', 'pointercancel', 'lostpointercapture'] as const) {
      canvas.addEventListener(name, (event) => this.onUp(event));
    }
    canvas.addEventListener('wheel', (event) => this.onWheel(event), {passive: false});
    canvas.addEventListener('dblclick', (event) => this.onDoubleClick(event));
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());
    canvas.addEventListener('keydown', (event) => this.onKey(event));
    canvas.addEventListener('keyup', (event) => this.keys.delete(event.code));
    canvas.addEventListener('blur', () => this.keys.clear());
  }

  /** Whether the ground is being dragged. */
  get isDragging(): boolean {
    return this.drag !== undefined && !this.drag.turns && !this.moves.isFlying;
  }

  get hasKeys(): boolean {
    return this.keys.size > 0;
  }

  /** Whether something is held that needs frames though nothing happens. */
  get isHolding(): boolean {
    return this.hasKeys || this.isDragging;
  }

  get held(): Held {
    const pair = (more: string[], less: string[]) =>
      Number(more.some((key) => this.keys.has(key))) -
      Number(less.some((key) => this.keys.has(key)));
    const turning =
      this.keys.has('ShiftLeft') || this.keys.has('ShiftRight') || this.moves.isFlying;
    const sideways = pair(['ArrowRight'], ['ArrowLeft']);
    const ahead = pair(['ArrowUp'], ['ArrowDown']);
    return {
      rightward: pair(['KeyD'], ['KeyA']) + (turning ? 0 : sideways),
      forward: pair(['KeyW'], ['KeyS']) + (turning ? 0 : ahead),
      upward: pair(['KeyE'], ['KeyQ']),
      turn: turning ? sideways : 0,
      tilt: turning ? ahead : 0,
      zoom: pair(['Equal', 'NumpadAdd'], ['Minus', 'NumpadSubtract']),
    };
  }

  private onDown(event: PointerEvent): void {
    this.canvas.focus({preventScroll: true});
    this.canvas.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, pointOf(event));
    if (this.pointers.size === 2) this.startPinch();
    if (this.pointers.size !== 1) return;
    const turns = event.button !== 0 || event.ctrlKey || event.shiftKey || event.metaKey;
    this.drag = {pivot: this.pivotAt(pointOf(event)), turns};
    this.onChange();
  }

  private onMove(event: PointerEvent): void {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const now = pointOf(event);
    this.pointers.set(event.pointerId, now);
    if (this.pinch) this.movePinch();
    else if (this.drag) this.moveDrag(now, now.x - before.x, now.y - before.y);
    this.onChange();
  }

  private moveDrag(now: Point, dx: number, dy: number): void {
    const {pivot, turns} = this.drag!;
    const {right, up} = this.placeOf(now);
    if (this.moves.isFlying) this.moves.look(-kDegPerPx * dx, kDegPerPx * dy);
    else if (turns) this.moves.orbit(pivot, kDegPerPx * dx, -kDegPerPx * dy);
    else this.moves.dragFrom(pivot, right, up);
  }

  private onUp(event: PointerEvent): void {
    if (!this.pointers.delete(event.pointerId)) return;
    this.pinch = undefined;
    // the finger that stays goes on dragging from where it is
    const [left] = this.pointers.values();
    this.drag = left && {pivot: this.pivotAt(left), turns: false};
    if (!left) this.moves.release();
  }

  private onWheel(event: WheelEvent): void {
    event.preventDefault();
    const px = event.deltaY * (event.deltaMode === 1 ? kPxPerLine : 1);
    // a pinch on a touchpad comes as a small wheel with ctrl
    const factor = Math.exp(px * kWheelPerPx * (event.ctrlKey ? 5 : 1));
    this.moves.zoomSoon(this.pivotAt(pointOf(event)), factor);
  }

  private onDoubleClick(event: MouseEvent): void {
    this.moves.zoomSoon(this.pivotAt(pointOf(event)), event.shiftKey ? 2.5 : 0.4);
  }

  private onKey(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const once: Record<string, () => void> = {
      Home: () => this.moves.home(),
      KeyH: () => this.moves.home(),
      KeyN: () => this.moves.faceNorth(),
      KeyF: () => this.moves.toggleFlying(),
    };
    const act = once[event.code];
    if (act && !event.repeat) act();
    const isHeld = /^(Arrow|Key[WASDQE]$|Equal|Minus|Numpad(Add|Subtract)|Shift)/.test(event.code);
    if (isHeld) this.keys.add(event.code);
    if (!act && !isHeld) return;
    if (!event.code.startsWith('Shift')) event.preventDefault();
    this.onChange();
  }

  private startPinch(): void {
    this.drag = undefined;
    const [a, b] = [...this.pointers.values()] as [Point, Point];
    const first = spanOf(a, b);
    this.pinch = {first, last: first, pivot: this.pivotAt(first.middle), kind: undefined};
  }

  private movePinch(): void {
    const [a, b] = [...this.pointers.values()] as [Point, Point];
    const pinch = this.pinch!;
    const now = spanOf(a, b);
    pinch.kind ??= kindOf(pinch.first, now);
    if (pinch.kind === 'tilt') {
      this.moves.orbit(pinch.pivot, 0, -kDegPerPx * (now.middle.y - pinch.last.middle.y));
    } else if (pinch.kind === 'zoom') {
      const {right, up} = this.placeOf(now.middle);
      this.moves.zoomAt(pinch.pivot, pinch.last.px / now.px);
      this.moves.orbit(pinch.pivot, -angleBetween(pinch.last.deg, now.deg), 0);
      this.moves.dragFrom(pinch.pivot, right, up);
    }
    pinch.last = now;
  }

  private pivotAt(point: Point): Vec3 {
    const {right, up} = this.placeOf(point);
    return this.moves.pivotAt(right, up);
  }

  private placeOf({x, y}: Point): {right: number; up: number} {
    const {clientWidth, clientHeight} = this.canvas;
    return {right: (2 * x) / clientWidth - 1, up: 1 - (2 * y) / clientHeight};
  }
}

interface Span {
  readonly middle: Point;
  readonly px: number;
  readonly deg: number;
}

interface Pinch {
  readonly first: Span;
  last: Span;
  readonly pivot: Vec3;
  kind: 'zoom' | 'tilt' | undefined;
}

/** Two fingers that go up or down side by side tilt; all else zooms, turns and moves. */
function kindOf(first: Span, now: Span): 'zoom' | 'tilt' | undefined {
  const arcPx = (Math.abs(angleBetween(first.deg, now.deg)) * Math.PI * now.px) / 360;
  if (Math.abs(now.px - first.px) > kDecidedPx || arcPx > kDecidedPx) return 'zoom';
  const [dx, dy] = [now.middle.x - first.middle.x, now.middle.y - first.middle.y];
  if (Math.hypot(dx, dy) < kDecidedPx) return undefined;
  return Math.abs(dy) > 1.5 * Math.abs(dx) ? 'tilt' : 'zoom';
}

function spanOf(a: Point, b: Point): Span {
  const [dx, dy] = [b.x - a.x, b.y - a.y];
  return {
    middle: {x: (a.x + b.x) / 2, y: (a.y + b.y) / 2},
    px: Math.max(1, Math.hypot(dx, dy)),
    deg: (Math.atan2(dy, dx) * 180) / Math.PI,
  };
}

function angleBetween(from: number, to: number): number {
  return to - from - 360 * Math.round((to - from) / 360);
}

function pointOf({offsetX, offsetY}: MouseEvent): Point {
  return {x: offsetX, y: offsetY};
}
