// validate_glb.mjs FOLDER: the Khronos validator over every glb of every tile set in FOLDER that has a
// tileset.json, once its compression is taken out.
import {existsSync} from 'node:fs';
import {join} from 'node:path';
import validator from 'gltf-validator';
import {check, failures} from './check.mjs';
import {glbFiles, tileSets} from './glb_files.mjs';
import {plainGlb} from './plain_glb.mjs';

/** What it says of every file and is meant so. */
const kExpected = new Set([
  // _MORPH is a displacement, which the core of glTF has no name for
  'UNUSED_OBJECT',
  // textures have a texel on either border; glTF 2.0 and WebGL 2 take any size
  'IMAGE_NPOT_DIMENSIONS',
  // CESIUM_tile_edges, of which the validator knows nothing
  'UNSUPPORTED_EXTENSION',
]);

const folder = process.argv[2];
await checkThatItLooksInside();
const names = (await tileSets(folder)).filter((name) => existsSync(join(folder, name, 'tileset.json')));
check(names.length > 0, 'there are tile sets');
for (const name of names) {
  let files = 0;
  const said = new Map();
  for await (const [file, bytes] of glbFiles(join(folder, name))) {
    const {glb} = await plainGlb(bytes);
    const report = await validator.validateBytes(glb, {maxIssues: 0});
    ++files;
    for (const {severity, code, message, pointer} of report.issues.messages) {
      if (severity <= 1 || !kExpected.has(code)) {
        said.set(`${severity} ${code}`, `${file} ${pointer ?? ''}: ${message}`);
      }
    }
  }
  check(files > 0 && said.size === 0, `${name}: ${files} glb without errors, warnings and notes`);
  for (const [code, example] of said) console.log(`     ${code}, for example ${example}`);
}

/** A bound that its values break must be found, or all of this says nothing. */
async function checkThatItLooksInside() {
  const [, bytes] = (await glbFiles(folder).next()).value;
  const text = new TextDecoder('latin1').decode(bytes);
  const spoiled = text.replace(/"max":\[\d/, (max) => max.slice(0, -1) + (max.endsWith('9') ? 8 : 9));
  const {glb} = await plainGlb(Uint8Array.from(spoiled, (c) => c.charCodeAt(0)));
  const {issues} = await validator.validateBytes(glb);
  check(issues.numErrors > 0, 'a spoiled max is an error');
}

process.exit(failures() > 0 ? 1 : 0);
