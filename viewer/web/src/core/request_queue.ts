/** Starts to fetch a tile; must reject when the signal is aborted. */
export type Fetch<Item, Content> = (item: Item, signal: AbortSignal) => Promise<Content>;

/** A request that did not succeed, and when it is tried again. */
export interface Failure {
  readonly attempts: number;
  readonly retryAtS: number;
  readonly message: string;
}

interface Keyed {
  readonly key: string;
}

const kFirstRetryS = 1;
const kLongestRetryS = 60;

/**
 * Fetches what is wanted: a few at a time, the first of the list first, and lets go of what is no
 * longer wanted. A failed item is tried again after 1, 2, 4, ... up to 60 seconds.
 */
export class RequestQueue<Item extends Keyed, Content> {
  private readonly inFlight = new Map<string, AbortController>();
  private readonly failed = new Map<string, Failure>();
  private startedCount = 0;

  /** @param onLoaded called once for each item that arrives; not for a cancelled one */
  constructor(
    private readonly fetchItem: Fetch<Item, Content>,
    private readonly onLoaded: (item: Item, content: Content) => void,
    private readonly onChange: () => void,
    private readonly largestInFlight = 8,
  ) {}

  /** Requests made so far, retries and cancelled ones included. */
  get started(): number {
    return this.startedCount;
  }

  get running(): number {
    return this.inFlight.size;
  }

  get failures(): ReadonlyMap<string, Failure> {
    return this.failed;
  }

  /** When the next failed item may be tried again, in seconds; Infinity if there is none. */
  get nextRetryS(): number {
    return Math.min(...[...this.failed.values()].map((failure) => failure.retryAtS));
  }

  /**
   * Says what is wanted now, most urgent first. Everything else is cancelled and forgotten.
   *
   * @param nowS seconds of any clock that never runs back
   */
  want(items: readonly Item[], nowS: number): void {
    const keys = new Set(items.map((item) => item.key));
    for (const [key, controller] of this.inFlight) {
      if (keys.has(key)) continue;
      this.inFlight.delete(key);
      controller.abort();
    }
    for (const key of this.failed.keys()) {
      if (!keys.has(key)) this.failed.delete(key);
    }
    for (const item of items) {
      if (this.inFlight.size >= this.largestInFlight) return;
      if (this.mayStart(item.key, nowS)) void this.start(item, nowS);
    }
  }

  private mayStart(key: string, nowS: number): boolean {
    return !this.inFlight.has(key) && nowS >= (this.failed.get(key)?.retryAtS ?? -Infinity);
  }

  private async start(item: Item, nowS: number): Promise<void> {
    const controller = new AbortController();
    this.inFlight.set(item.key, controller);
    ++this.startedCount;
    try {
      const content = await this.fetchItem(item, controller.signal);
      if (this.inFlight.get(item.key) !== controller) return;
      this.failed.delete(item.key);
      this.onLoaded(item, content);
    } catch (error) {
      if (this.inFlight.get(item.key) !== controller) return;
      this.failed.set(item.key, this.nextFailure(item.key, nowS, error));
    }
    this.inFlight.delete(item.key);
    this.onChange();
  }

  private nextFailure(key: string, nowS: number, error: unknown): Failure {
    const attempts = (this.failed.get(key)?.attempts ?? 0) + 1;
    const waitS = Math.min(kLongestRetryS, kFirstRetryS * 2 ** (attempts - 1));
    const message = error instanceof Error ? error.message : String(error);
    return {attempts, retryAtS: nowS + waitS, message};
  }
}
