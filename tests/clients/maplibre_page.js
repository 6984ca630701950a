// In the browser: MapLibre with terrain and hillshade from raster tiles of heights, as its users set it up.
import {Map as MapLibre} from '/maplibre/maplibre-gl.mjs';

/**
 * @param url of tiles.json
 * @param places longitudes and latitudes
 * @returns the terrain's heights there
 * @throws Error of MapLibre's
 */
window.show = async (url, places) => {
  const tiles = await (await fetch(url)).json();
  // MapLibre takes addresses as they are: those of tiles.json are relative to it
  const dem = {type: 'raster-dem', url, tiles: tiles.tiles.map((path) => new URL('.', url).href + path)};
  const [west, south, east, north] = tiles.bounds;
  const map = new MapLibre({
    container: 'map', attributionControl: false, fadeDuration: 0, pixelRatio: 1,
    center: [(west + east) / 2, (south + north) / 2], zoom: 10.2, pitch: 0, maxPitch: 80,
    style: {
      version: 8, sources: {dem, shade: dem}, terrain: {source: 'dem'},
      layers: [
        {id: 'ground', type: 'background', paint: {'background-color': '#dcd2b4'}},
        {id: 'hills', type: 'hillshade', source: 'shade', paint: {'hillshade-exaggeration': 0.7}},
      ],
    },
  });
  const idle = () => new Promise((resolve, reject) => {
    map.once('idle', resolve);
    map.once('error', ({error}) => reject(error));
  });
  await idle();
  // all of it is seen, with the finest tiles
  const heights = places.map((place) => map.queryTerrainElevation(place));
  map.jumpTo({center: [(west + east) / 2, (south + north) / 2], zoom: 10.2, pitch: 55, bearing: 20});
  await idle();
  return heights;
};
