// node simplify.mjs delatin|martini HEIGHTS COLUMNS ROWS TOLERANCE_M OUT
//
// HEIGHTS: floats, row by row. OUT: CPU seconds (float64), number of vertices and of triangles
// (uint32), vertices (column, row, height; float64), triangles (uint32).
import {readFileSync, writeFileSync} from 'node:fs';

import Martini from '@mapbox/martini';
import Delatin from 'delatin';

const [which, file, columnsText, rowsText, toleranceText, out] = process.argv.slice(2);
const [columns, rows, tolerance] = [columnsText, rowsText, toleranceText].map(Number);
const bytes = readFileSync(file);
const heights = new Float32Array(bytes.buffer, bytes.byteOffset, columns * rows);

function withDelatin() {
  const tin = new Delatin(heights, columns, rows);
  tin.run(tolerance);
  return {points: tin.coords, triangles: tin.triangles};
}

// Its grid has a side of 2^n + 1: the rest repeats the last sample of each row and column, and only
// triangles that reach into the real grid are counted.
function withMartini() {
  let side = 2;
  while (side + 1 < Math.max(columns, rows)) side *= 2;
  side += 1;
  const padded = new Float32Array(side * side);
  for (let row = 0; row < side; ++row) {
    for (let column = 0; column < side; ++column) {
      padded[row * side + column] =
        heights[Math.min(row, rows - 1) * columns + Math.min(column, columns - 1)];
    }
  }
  const mesh = new Martini(side).createTile(padded).getMesh(tolerance);
  const reaches = [];
  for (let t = 0; t < mesh.triangles.length; t += 3) {
    const corners = [...mesh.triangles.slice(t, t + 3)];
    const left = Math.min(...corners.map((v) => mesh.vertices[2 * v]));
    const top = Math.min(...corners.map((v) => mesh.vertices[2 * v + 1]));
    if (left < columns - 1 && top < rows - 1) reaches.push(...corners);
  }
  const heightAt = (column, row) => padded[row * side + column];
  return {points: mesh.vertices, triangles: reaches, heightAt};
}

const begin = process.cpuUsage();
const mesh = which === 'delatin' ? withDelatin() : withMartini();
const used = process.cpuUsage(begin);

const heightAt = mesh.heightAt ?? ((column, row) => heights[row * columns + column]);
const count = mesh.points.length / 2;
const points = new Float64Array(3 * count);
for (let v = 0; v < count; ++v) {
  const [column, row] = [mesh.points[2 * v], mesh.points[2 * v + 1]];
  points.set([column, row, heightAt(column, row)], 3 * v);
}
const parts = [
  new Float64Array([(used.user + used.system) / 1e6]),
  new Uint32Array([count, mesh.triangles.length / 3]),
  points,
  new Uint32Array(mesh.triangles),
];
writeFileSync(out, Buffer.concat(parts.map((part) => Buffer.from(part.buffer))));
