/**
 * Keeps what was used last, up to a number of bytes.
 *
 * A kept entry (see trim) is never dropped, even over the limit: a picture with holes would be
 * worse than a full memory.
 */
export class TileCache<Content> {
  private readonly entries = new Map<string, {content: Content; bytes: number}>();
  private bytesInUse = 0;

  /** @param onDrop frees what the content holds */
  constructor(
    private readonly limitBytes: number,
    private readonly onDrop: (content: Content) => void,
  ) {}

  get bytes(): number {
    return this.bytesInUse;
  }

  has(key: string): boolean {
    return this.entries.has(key);
  }

  get(key: string): Content | undefined {
    return this.entries.get(key)?.content;
  }

  /** Adds an entry as the one used last. An entry of the same key is dropped. */
  put(key: string, content: Content, bytes: number): void {
    this.drop(key);
    this.entries.set(key, {content, bytes});
    this.bytesInUse += bytes;
  }

  /** Marks an entry as the one used last. */
  touch(key: string): void {
    const entry = this.entries.get(key);
    if (!entry) return;
    // a Map iterates in the order of insertion: the longest unused comes first
    this.entries.delete(key);
    this.entries.set(key, entry);
  }

  /** Drops the longest unused entries that are not kept until the rest fits the limit. */
  trim(kept: ReadonlySet<string>): void {
    for (const key of [...this.entries.keys()]) {
      if (this.bytesInUse <= this.limitBytes) return;
      if (!kept.has(key)) this.drop(key);
    }
  }

  private drop(key: string): void {
    const entry = this.entries.get(key);
    if (!entry) return;
    this.entries.delete(key);
    this.bytesInUse -= entry.bytes;
    this.onDrop(entry.content);
  }
}
