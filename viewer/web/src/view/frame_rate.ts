/** Pictures per second, smoothed over about ten of them. */
export class FrameRate {
  private lastMs = -Infinity;
  private intervalMs = 0;

  /** @param nowMs when a picture was drawn */
  tick(nowMs: number): void {
    const elapsedMs = nowMs - this.lastMs;
    this.lastMs = nowMs;
    // a long pause means that nothing moved, not that drawing was slow
    if (elapsedMs > 1000) this.intervalMs = 0;
    else this.intervalMs = this.intervalMs ? 0.9 * this.intervalMs + 0.1 * elapsedMs : elapsedMs;
  }

  get framesPerS(): number | undefined {
    return this.intervalMs > 0 ? 1000 / this.intervalMs : undefined;
  }
}
