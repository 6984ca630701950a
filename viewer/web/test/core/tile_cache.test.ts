import {describe, expect, it} from 'vitest';
import {TileCache} from '../../src/core/tile_cache';

function makeCache(limitBytes: number) {
  const dropped: string[] = [];
  return {cache: new TileCache<string>(limitBytes, (content) => dropped.push(content)), dropped};
}

describe('TileCache', () => {
  it('drops the longest unused first, and no more than needed', () => {
    const {cache, dropped} = makeCache(100);
    for (const key of ['a', 'b', 'c']) cache.put(key, key, 50);
    cache.touch('a');
    cache.trim(new Set());
    expect(dropped).toEqual(['b']);
    expect(cache.bytes).toBe(100);
  });

  it('never drops what is kept, even over the limit', () => {
    const {cache, dropped} = makeCache(10);
    for (const key of ['a', 'b', 'c']) cache.put(key, key, 50);
    cache.trim(new Set(['a', 'c']));
    expect(dropped).toEqual(['b']);
    expect([cache.has('a'), cache.has('b'), cache.has('c')]).toEqual([true, false, true]);
    expect(cache.bytes).toBe(100);
  });

  it('frees the content that a second one of the same key replaces', () => {
    const {cache, dropped} = makeCache(100);
    cache.put('a', 'old', 30);
    cache.put('a', 'new', 40);
    expect(dropped).toEqual(['old']);
    expect(cache.get('a')).toBe('new');
    expect(cache.bytes).toBe(40);
  });
});
