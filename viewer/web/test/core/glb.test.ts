import {MeshoptDecoder, MeshoptEncoder} from 'meshoptimizer';
import {beforeAll, describe, expect, it} from 'vitest';
import {readGlb, type DecodeMeshopt} from '../../src/core/glb';
import {glbOf, makeTile} from '../synthetic_tiles.mjs';

const decode: DecodeMeshopt = (...stream) =>
  MeshoptDecoder.decodeGltfBuffer(
    ...(stream as Parameters<typeof MeshoptDecoder.decodeGltfBuffer>),
  );

const bytesOf = (tile: unknown): ArrayBuffer => {
  const made = glbOf(tile as Parameters<typeof glbOf>[0]) as Uint8Array;
  return Uint8Array.from(made).buffer;
};

beforeAll(async () => {
  await MeshoptEncoder.ready;
  await MeshoptDecoder.ready;
});

describe('readGlb', () => {
  it('gives the numbers that were written', () => {
    const tile = makeTile(1, 1, 1)!;
    const read = readGlb(bytesOf(tile), [1, 1, 1], decode);
    expect(read.origin).toEqual(tile.origin);
    expect(read.positions).toEqual(Int16Array.from(tile.positions as number[]));
    expect(read.toTargets).toEqual(Int16Array.from(tile.toTargets as number[]));
    expect(read.normals).toEqual(Int8Array.from(tile.normals as number[]));
    // the codec may turn a triangle's corners, and nothing else
    const turned = (indices: ArrayLike<number>) =>
      Array.from({length: indices.length / 3}, (_, i) => {
        const [a, b, c] = [indices[3 * i]!, indices[3 * i + 1]!, indices[3 * i + 2]!];
        const first = Math.min(a, b, c);
        return first === a ? [a, b, c] : first === b ? [b, c, a] : [c, a, b];
      });
    expect(turned(read.indices)).toEqual(turned(tile.indices as number[]));
  });

  it('puts water after the land', () => {
    const tile = makeTile(1, 1, 1)!;
    const indices = tile.indices as number[];
    const half = 3 * Math.floor(indices.length / 6);
    const whole = readGlb(bytesOf(tile), [1, 1, 1], decode);
    expect(whole.landIndices).toBe(indices.length);
    const read = readGlb(bytesOf({...tile, landIndices: half}), [1, 1, 1], decode);
    expect(read.landIndices).toBe(half);
    const triangles = (of: ArrayLike<number>, from: number, to: number) =>
      Array.from({length: (to - from) / 3}, (_, i) =>
        [0, 1, 2].map((k) => of[from + 3 * i + k]!).sort((a, b) => a - b),
      );
    expect(triangles(read.indices, 0, half)).toEqual(triangles(indices, 0, half));
    expect(triangles(read.indices, half, indices.length)).toEqual(
      triangles(indices, half, indices.length),
    );
  });

  it('reads a tile that is all water', () => {
    const tile = makeTile(1, 1, 1)!;
    const read = readGlb(bytesOf({...tile, landIndices: 0}), [1, 1, 1], decode);
    expect(read.landIndices).toBe(0);
    expect(read.indices.length).toBe((tile.indices as number[]).length);
  });

  it('says what is missing', () => {
    expect(() => readGlb(new ArrayBuffer(64), [1, 1, 1], decode)).toThrow('no glb');
  });
});
