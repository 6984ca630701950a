import {BufferAttribute} from 'three';

type Numbers = Uint32Array | Float32Array | Uint8Array;

/** Runs of elements: begin, end, begin, end, ... */
export type Runs = ArrayLike<number>;

/** A buffer with room to grow, of which only what has changed is sent to the graphics card. */
export class GrowingAttribute {
  attribute: BufferAttribute;
  /** Bytes to send for the last change. */
  changedBytes = 0;

  constructor(
    private readonly make: (length: number) => Numbers,
    private readonly itemSize: number,
    private readonly normalized = false,
  ) {
    this.attribute = new BufferAttribute(make(0), itemSize, normalized);
  }

  /**
   * Has room for so many numbers from now on.
   *
   * @returns whether there is a new, empty attribute for that
   */
  reserve(length: number): boolean {
    if (length <= this.attribute.array.length) return false;
    this.attribute = new BufferAttribute(this.make(Math.ceil(1.5 * length)), this.itemSize, this.normalized);
    return true;
  }

  /**
   * Takes runs over from an array of which this one is a copy otherwise.
   *
   * @param stride numbers of an element of the runs
   */
  take(source: Numbers, runs: Runs, stride: number): void {
    this.write(runs, stride, (begin, end) => {
      (this.attribute.array as Numbers).set(source.subarray(begin, end), begin);
    });
  }

  /** Writes runs, whatever is in them. */
  write(runs: Runs, stride: number, fill: (begin: number, end: number) => void): void {
    const {attribute} = this;
    this.changedBytes = 0;
    for (let i = 0; i < runs.length; i += 2) {
      const [begin, end] = [stride * runs[i]!, stride * runs[i + 1]!];
      fill(begin, end);
      attribute.addUpdateRange(begin, end - begin);
      this.changedBytes += (end - begin) * attribute.array.BYTES_PER_ELEMENT;
    }
    if (runs.length > 0) attribute.needsUpdate = true;
  }
}
