import type {GlbTile} from '../core/glb';
import type {Vec3} from '../core/vec3';
import type {DecodeAnswer, DecodeRequest} from './decode_worker';
import DecodeWorker from './decode_worker?worker&inline';

/** A tile's numbers, and its image if it has one. */
export interface Decoded {
  readonly tile: GlbTile;
  readonly image?: ImageBitmap;
}

interface Waiting {
  readonly resolve: (decoded: Decoded) => void;
  readonly reject: (error: Error) => void;
}

/** Hands files to a worker and gives what it makes of them. */
export class TileDecoder {
  private readonly worker: Worker = new DecodeWorker();
  private readonly waiting = new Map<number, Waiting>();
  private nextId = 0;

  constructor() {
    this.worker.onmessage = ({data}: MessageEvent<DecodeAnswer>) => this.settle(data);
  }

  /** Takes the file over: it is empty afterwards. Rejects with what the file lacks. */
  decode(file: ArrayBuffer, stepM: Vec3): Promise<Decoded> {
    const request: DecodeRequest = {id: this.nextId++, file, stepM};
    return new Promise((resolve, reject) => {
      this.waiting.set(request.id, {resolve, reject});
      this.worker.postMessage(request, [file]);
    });
  }

  private settle(answer: DecodeAnswer): void {
    const waiting = this.waiting.get(answer.id);
    this.waiting.delete(answer.id);
    if ('message' in answer) waiting?.reject(new Error(answer.message));
    else waiting?.resolve(answer);
  }
}
