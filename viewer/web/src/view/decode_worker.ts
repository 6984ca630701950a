// Decodes tiles away from the page's thread: what it gets is a file, what it sends is arrays.
import {MeshoptDecoder} from 'three/examples/jsm/libs/meshopt_decoder.module.js';
import {readGlb, type GlbTile} from '../core/glb';
import type {Vec3} from '../core/vec3';

export interface DecodeRequest {
  readonly id: number;
  readonly file: ArrayBuffer;
  readonly stepM: Vec3;
}

export type DecodeAnswer =
  | {readonly id: number; readonly tile: GlbTile; readonly image?: ImageBitmap}
  | {readonly id: number; readonly message: string};

// the page's types do not know that this file runs in a worker
const worker = self as unknown as {
  onmessage: (event: MessageEvent<DecodeRequest>) => void;
  postMessage: (answer: DecodeAnswer, transfer: Transferable[]) => void;
};

worker.onmessage = async ({data: {id, file, stepM}}) => {
  try {
    await MeshoptDecoder.ready;
    const tile = readGlb(file, stepM, (...stream) => MeshoptDecoder.decodeGltfBuffer(...stream));
    const image = tile.image && (await decodedImage(tile.image));
    const {positions, toTargets, normals, indices, colors, places} = tile;
    const arrays = [positions, toTargets, normals, indices, colors, places];
    const buffers = arrays.flatMap((array) => (array ? [array.buffer as ArrayBuffer] : []));
    worker.postMessage({id, tile, image}, image ? [...buffers, image] : buffers);
  } catch (error) {
    worker.postMessage({id, message: error instanceof Error ? error.message : String(error)}, []);
  }
};

/** Images of glTF have their first row on top, as textures have it at 0. */
function decodedImage({bytes, type}: NonNullable<GlbTile['image']>): Promise<ImageBitmap> {
  const blob = new Blob([bytes as BlobPart], {type});
  return createImageBitmap(blob, {colorSpaceConversion: 'none', premultiplyAlpha: 'none'});
}
