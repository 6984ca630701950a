// The edge of a tile's mesh: what it shares with its neighbours, and the outline of the data.

/** A triangle mesh's edges that have a triangle on one side only. */
export interface Border {
  /** Vertex numbers, each once, growing. */
  readonly vertices: readonly number[];
  /** Pairs of vertex numbers. */
  readonly edges: readonly (readonly [number, number])[];
}

/** Finds the edges that exactly one triangle has. */
export function borderOf(indices: ArrayLike<number>, vertexCount: number): Border {
  const uses = new Map<number, number>();
  for (let i = 0; i < indices.length; ++i) {
    const a = indices[i]!;
    const b = indices[i % 3 === 2 ? i - 2 : i + 1]!;
    const key = Math.min(a, b) * vertexCount + Math.max(a, b);
    uses.set(key, (uses.get(key) ?? 0) + 1);
  }
  const edges = [...uses]
    .filter(([, count]) => count === 1)
    .map(([key]) => [Math.floor(key / vertexCount), key % vertexCount] as const);
  const vertices = [...new Set(edges.flat())].sort((a, b) => a - b);
  return {vertices, edges};
}
