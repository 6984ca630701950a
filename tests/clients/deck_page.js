// In the browser: deck.gl's Tile3DLayer with loaders.gl, as its users set it up.
import {Deck, MapView} from '@deck.gl/core';
import {Tile3DLayer} from '@deck.gl/geo-layers';
import {Tiles3DLoader} from '@loaders.gl/3d-tiles';

// by itself it fetches its decoder from elsewhere
const kDraco = {'draco_wasm_wrapper.js': '/draco/draco_wasm_wrapper.js', 'draco_decoder.wasm': '/draco/draco_decoder.wasm'};

/** Shows a tileset from above until nothing more is loaded. */
window.show = ({url, maximumScreenSpaceError, span}) => new Promise((resolve, reject) => {
  const failed = [];
  let tileset, calm = 0, frames = 0;
  const deck = new Deck({
    parent: document.body, width: 640, height: 480, views: new MapView({farZMultiplier: 4}), useDevicePixels: 1,
    initialViewState: {longitude: 0, latitude: 0, zoom: 10},
    layers: [new Tile3DLayer({
      id: 'terrane', data: url, loader: Tiles3DLoader,
      loadOptions: {worker: false, modules: kDraco, tileset: {maximumScreenSpaceError, throttleRequests: false}},
      onTilesetLoad: (loaded) => {
        tileset = loaded;
        const [longitude, latitude] = tileset.cartographicCenter;
        const zoom = Math.log2((40075017 * Math.cos((latitude * Math.PI) / 180) * 480) / (512 * span));
        deck.setProps({initialViewState: {longitude, latitude, zoom, pitch: 35, bearing: 20}});
      },
      onTileError: (tile, message, lost) => failed.push(`${lost}: ${message}`),
    })],
    onError: (error) => failed.push(String(error)),
    onAfterRender: () => {
      calm = tileset?.isLoaded() && tileset.selectedTiles.length > 0 ? calm + 1 : 0;
      if (calm > 20) resolve({failed, tiles: tileset.selectedTiles.map((tile) => tile.contentUrl)});
      else if (++frames > 3000) reject(new Error('not ready after 3000 frames'));
      else requestAnimationFrame(() => deck.redraw('again'));
    },
  });
  window.deck = deck;
});
