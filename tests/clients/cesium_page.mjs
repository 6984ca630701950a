// A page with CesiumJS and nothing from anywhere else: no ion, no imagery, no sky.
import {fileURLToPath} from 'node:url';

const kCesium = fileURLToPath(new URL('node_modules/cesium/Build/Cesium/', import.meta.url));

/** What servePages() needs for the page, and for tiles below /tiles/. */
export function cesiumMounts(tiles) {
  return {'/cesium.html': () => kPage, '/cesium/': kCesium, '/tiles/': tiles};
}

/** The colour behind everything. */
export const kBackground = [0, 0, 0];

const kPage = `<!doctype html><meta charset="utf-8">
<link rel="stylesheet" href="/cesium/Widgets/widgets.css">
<style>html, body, #view { margin: 0; width: 100%; height: 100%; background: black; }</style>
<div id="view"></div>
<script>window.CESIUM_BASE_URL = '/cesium/';</script>
<script src="/cesium/Cesium.js"></script>
<script>
  Cesium.Ion.defaultAccessToken = undefined;
  function makeViewer(more) {
    const viewer = new Cesium.Viewer('view', {
      baseLayer: false, animation: false, timeline: false, baseLayerPicker: false, geocoder: false,
      homeButton: false, sceneModePicker: false, navigationHelpButton: false, infoBox: false,
      fullscreenButton: false, selectionIndicator: false, skyBox: false, skyAtmosphere: false,
      orderIndependentTranslucency: false, scene3DOnly: true, msaaSamples: 1,
      contextOptions: {webgl: {antialias: false}}, ...more,
    });
    const {scene} = viewer;
    scene.fog.enabled = false;
    scene.globe.showGroundAtmosphere = false;
    scene.backgroundColor = Cesium.Color.BLACK;
    scene.screenSpaceCameraController.enableInputs = false;
    // noon at the data sets, or they are drawn at night
    viewer.clock.currentTime = Cesium.JulianDate.fromIso8601('2024-06-21T19:00:00Z');
    viewer.clock.shouldAnimate = false;
    window.renderErrors = [];
    scene.renderError.addEventListener((_, error) => window.renderErrors.push(String(error)));
    return viewer;
  }
</script>`;
