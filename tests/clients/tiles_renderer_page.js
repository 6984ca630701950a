// In the browser: 3d-tiles-renderer with three.js, as its users set it up.
import {TilesRenderer} from '3d-tiles-renderer';
import {GLTFExtensionsPlugin, ImplicitTilingPlugin, ReorientationPlugin} from '3d-tiles-renderer/plugins';
import {TilesetValidationPlugin} from '3d-tiles-renderer/src/three/plugins/TilesetValidationPlugin.js';
import {AmbientLight, DirectionalLight, PerspectiveCamera, Scene, Sphere, Vector3, WebGLRenderer} from 'three';
import {DRACOLoader} from 'three/addons/loaders/DRACOLoader.js';
import {MeshoptDecoder} from 'three/addons/libs/meshopt_decoder.module.js';

/**
 * Shows a tileset until nothing more is loaded.
 *
 * @param validated its boxes are checked against what is in them
 */
window.show = async ({url, finestError, radius, validated}) => {
  const renderer = new WebGLRenderer({preserveDrawingBuffer: true});
  renderer.setSize(640, 480);
  document.body.replaceChildren(renderer.domElement);

  const tiles = new TilesRenderer(url);
  const dracoLoader = new DRACOLoader().setDecoderPath('/draco/');
  tiles.registerPlugin(new GLTFExtensionsPlugin({meshoptDecoder: MeshoptDecoder, dracoLoader}));
  tiles.registerPlugin(new ReorientationPlugin({recenter: true}));
  tiles.registerPlugin(new ImplicitTilingPlugin());
  if (validated) tiles.registerPlugin(new TilesetValidationPlugin());
  const failed = [];
  tiles.addEventListener('load-error', ({url: lost, error}) => failed.push(`${lost}: ${error}`));

  const camera = new PerspectiveCamera(60, 640 / 480, 1, 1e7);
  tiles.setCamera(camera);
  tiles.setResolution(camera, 640, 480);
  const sun = new DirectionalLight(0xffffff, 2);
  sun.position.set(1, 2, 1);
  const scene = new Scene();
  scene.add(tiles.group, sun, new AmbientLight(0xffffff, 1));

  await settle(tiles, camera, () => tiles.root);
  const sphere = new Sphere();
  tiles.getBoundingSphere(sphere);
  const centre = sphere.center.clone().applyMatrix4(tiles.group.matrixWorld);
  camera.position.copy(centre).add(new Vector3(0.5, 0.6, -1).multiplyScalar(1.1 * radius));
  camera.lookAt(centre);
  camera.updateMatrixWorld();
  // the nearest part at level 1 or 0, the farthest at higher ones
  const distance = camera.position.distanceTo(centre) - 0.6 * radius;
  tiles.errorTarget = (4 * finestError * 480) / (2 * Math.tan(Math.PI / 6) * distance);
  let calm = 0;
  await settle(tiles, camera, () => (calm = tiles.loadProgress === 1 && tiles.visibleTiles.size > 0 ? calm + 1 : 0) > 20);
  renderer.render(scene, camera);
  return {
    failed,
    tiles: [...tiles.visibleTiles].map((tile) => new URL(tile.content.uri, tile.internal.basePath + '/').href),
    triangles: renderer.info.render.triangles,
  };
};

async function settle(tiles, camera, isDone) {
  for (let frame = 0; frame < 3000; ++frame) {
    camera.updateMatrixWorld();
    tiles.update();
    await new Promise((resolve) => requestAnimationFrame(resolve));
    if (isDone()) return;
  }
  throw new Error('not ready after 3000 frames');
}
