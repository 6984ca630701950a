// read_glb.mjs FOLDER: opens every glb of every tile set in FOLDER with three.js' GLTFLoader and with
// gltf-transform, and compares what they find with the plain numbers in the file.
import {join} from 'node:path';
import {NodeIO} from '@gltf-transform/core';
import {ALL_EXTENSIONS} from '@gltf-transform/extensions';
import draco3d from 'draco3dgltf';
import {MeshoptDecoder, MeshoptEncoder} from 'meshoptimizer';
import {GLTFLoader} from 'three/addons/loaders/GLTFLoader.js';
import {check, failures} from './check.mjs';
import {glbFiles, tileSets} from './glb_files.mjs';
import {plainGlb, readGlb} from './plain_glb.mjs';

globalThis.self = globalThis;  // GLTFLoader's only wish for a browser, where there are no textures

const io = new NodeIO().registerExtensions(ALL_EXTENSIONS).registerDependencies({
  'meshopt.decoder': MeshoptDecoder,
  'meshopt.encoder': MeshoptEncoder,
  'draco3d.decoder': await draco3d.createDecoderModule(),
});
const three = new GLTFLoader().setMeshoptDecoder(MeshoptDecoder);

/** Sums that change where any vertex or triangle does. */
class Sums {
  vertices = 0;
  triangles = 0;
  position = [0, 0, 0];
  morph = [0, 0, 0];

  add(vertices, triangles, positionOf, morphOf) {
    this.vertices += vertices;
    this.triangles += triangles;
    for (let v = 0; v < vertices; ++v) {
      for (let axis = 0; axis < 3; ++axis) {
        this.position[axis] += positionOf(v, axis) * ((v % 7) + 1);
        this.morph[axis] += morphOf(v, axis) * ((v % 7) + 1);
      }
    }
  }

  text() {
    return JSON.stringify(this);
  }
}

async function plainSums(bytes) {
  const {json, glb} = await plainGlb(bytes);
  const {binary} = readGlb(glb);
  const sums = new Sums();
  for (const {attributes, indices} of json.meshes[0].primitives) {
    const position = reader(json, binary, attributes.POSITION);
    const morph = reader(json, binary, attributes._MORPH);
    sums.add(json.accessors[attributes.POSITION].count, json.accessors[indices].count / 3, position, morph);
  }
  return sums.text();
}

function reader(json, binary, index) {
  const {bufferView, byteOffset: inView = 0, componentType} = json.accessors[index];
  const {byteOffset, byteStride} = json.bufferViews[bufferView];
  const view = new DataView(binary.buffer, binary.byteOffset + byteOffset + inView);
  const isShort = componentType === 5122;
  const width = isShort ? 2 : 4;
  const stride = byteStride ?? 3 * width;
  return (v, axis) => {
    const at = v * stride + axis * width;
    return isShort ? view.getInt16(at, true) : view.getFloat32(at, true);
  };
}

function threeSums({scene}) {
  const sums = new Sums();
  scene.traverse(({geometry}) => {
    if (!geometry) return;
    const {position, _morph} = geometry.attributes;
    sums.add(position.count, geometry.index.count / 3, (v, k) => position.getComponent(v, k),
      (v, k) => _morph.getComponent(v, k));
  });
  return sums.text();
}

function transformSums(document) {
  const sums = new Sums();
  for (const primitive of document.getRoot().listMeshes()[0].listPrimitives()) {
    const position = primitive.getAttribute('POSITION').getArray();
    const morph = primitive.getAttribute('_MORPH').getArray();
    sums.add(position.length / 3, primitive.getIndices().getCount() / 3, (v, k) => position[3 * v + k],
      (v, k) => morph[3 * v + k]);
  }
  return sums.text();
}

/** Without pictures, which need a browser, and without Draco, which needs workers. */
function isForThree({extensionsUsed = [], images}) {
  return !images && !extensionsUsed.includes('KHR_draco_mesh_compression');
}

for (const name of await tileSets(process.argv[2])) {
  const folder = join(process.argv[2], name);
  let files = 0, byThree = 0;
  const wrong = [];
  for await (const [file, bytes] of glbFiles(folder)) {
    ++files;
    const expected = await plainSums(bytes);
    if (transformSums(await io.readBinary(bytes)) !== expected) wrong.push(`gltf-transform, ${file}`);
    if (!isForThree(readGlb(bytes).json)) continue;
    ++byThree;
    const scene = await three.parseAsync(bytes.buffer, '');
    if (threeSums(scene) !== expected) wrong.push(`three.js, ${file}`);
  }
  check(files > 0 && wrong.length === 0,
    `${name}: gltf-transform reads ${files} glb as they are, three.js ${byThree} of them`);
  for (const line of wrong.slice(0, 3)) console.log(`     ${line}`);
}
process.exit(failures() > 0 ? 1 : 0);
