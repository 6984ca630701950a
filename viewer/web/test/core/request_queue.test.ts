import {describe, expect, it} from 'vitest';
import {RequestQueue} from '../../src/core/request_queue';

interface Item {
  readonly key: string;
}

const items = (keys: string): Item[] => [...keys].map((key) => ({key}));

/** A server whose answers the test gives by hand. */
class HandServer {
  readonly open = new Map<string, {resolve: (s: string) => void; reject: (e: Error) => void}>();
  readonly asked: string[] = [];
  readonly cancelled: string[] = [];
  readonly loaded: string[] = [];

  readonly queue = new RequestQueue<Item, string>(
    ({key}, signal) =>
      new Promise((resolve, reject) => {
        this.asked.push(key);
        this.open.set(key, {resolve, reject});
        signal.addEventListener('abort', () => {
          this.cancelled.push(key);
          reject(new Error('aborted'));
        });
      }),
    ({key}) => this.loaded.push(key),
    () => {},
  );

  async answer(key: string): Promise<void> {
    this.open.get(key)!.resolve(key);
    await settle();
  }

  async fail(key: string): Promise<void> {
    this.open.get(key)!.reject(new Error(`no ${key}`));
    await settle();
  }
}

const settle = () => new Promise((resolve) => setTimeout(resolve, 0));

describe('RequestQueue', () => {
  it('has at most eight requests in flight, the first of the list first', () => {
    const server = new HandServer();
    server.queue.want(items('abcdefghij'), 0);
    expect(server.asked.join('')).toBe('abcdefgh');
    server.queue.want(items('abcdefghij'), 1);
    expect(server.queue.running).toBe(8);
  });

  it('goes on with the next when one has arrived', async () => {
    const server = new HandServer();
    server.queue.want(items('abcdefghij'), 0);
    await server.answer('c');
    expect(server.loaded).toEqual(['c']);
    server.queue.want(items('abdefghij'), 1);
    expect(server.asked.join('')).toBe('abcdefghi');
  });

  it('cancels what is no longer wanted, which is not a failure', async () => {
    const server = new HandServer();
    server.queue.want(items('ab'), 0);
    server.queue.want(items('bc'), 1);
    await settle();
    expect(server.cancelled).toEqual(['a']);
    expect(server.queue.failures.size).toBe(0);
    expect(server.queue.running).toBe(2);
    expect(server.loaded).toEqual([]);
  });

  it('asks again for what was cancelled and is wanted again, and loads it once', async () => {
    const server = new HandServer();
    server.queue.want(items('a'), 0);
    server.queue.want([], 1);
    server.queue.want(items('a'), 1);
    await settle();
    await server.answer('a');
    expect(server.loaded).toEqual(['a']);
    expect(server.queue.running).toBe(0);
  });

  it('tries a failed one again after 1, 2, 4 seconds and never waits over a minute', async () => {
    const server = new HandServer();
    let nowS = 0;
    const waits: number[] = [];
    for (let i = 0; i < 9; ++i) {
      server.queue.want(items('a'), nowS);
      await server.fail('a');
      expect(server.queue.failures.get('a')!.message).toBe('no a');
      waits.push(server.queue.nextRetryS - nowS);
      server.queue.want(items('a'), server.queue.nextRetryS - 0.01);
      expect(server.queue.running).toBe(0);
      nowS = server.queue.nextRetryS;
    }
    expect(waits).toEqual([1, 2, 4, 8, 16, 32, 60, 60, 60]);
  });

  it('forgets a failure when the tile arrives or is no longer wanted', async () => {
    const server = new HandServer();
    server.queue.want(items('ab'), 0);
    await server.fail('a');
    await server.fail('b');
    server.queue.want(items('a'), 1);
    expect([...server.queue.failures.keys()]).toEqual(['a']);
    await server.answer('a');
    expect(server.queue.failures.size).toBe(0);
    expect(server.queue.nextRetryS).toBe(Infinity);
  });

  it('does not let a failed tile hold up the others', async () => {
    const server = new HandServer();
    server.queue.want(items('abcdefg'), 0);
    await server.fail('a');
    server.queue.want(items('abcdefg'), 0.5);
    expect(server.asked.join('')).toBe('abcdefg');
  });
});
