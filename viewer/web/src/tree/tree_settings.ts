// What the user of the page of trees can set, and what the engine makes of it.
import type {Vec3} from '../core/vec3';
import type {ViewCriteria} from './view_engine';

export interface TreeSettings {
  readonly measure: ViewCriteria['measure'];
  readonly tolerancePx: number;
  readonly frustum: boolean;
  readonly backFaces: boolean;
  readonly silhouettes: boolean;
  readonly highlight: boolean;
  /** Fine where the colour varies. */
  readonly colours: boolean;
  /** Triangles that are shown at most; null: as many as the tolerance takes. */
  readonly budget: number | null;
  /** Splits and merges take a few frames. */
  readonly blend: boolean;
  readonly wireframe: boolean;
  /** The mesh stays as it is while the camera moves on. */
  readonly frozen: boolean;
  readonly lightAzimuthDeg: number;
  readonly lightHeightDeg: number;
}

export const kTreeDefaults: TreeSettings = {
  measure: 'error',
  tolerancePx: 1,
  frustum: false,
  backFaces: false,
  silhouettes: false,
  highlight: false,
  colours: false,
  budget: null,
  blend: false,
  wireframe: true,
  frozen: false,
  lightAzimuthDeg: 40,
  lightHeightDeg: 50,
};

/** Also of the light that is drawn. */
export const kShininess = 20;
export const kMorphFrames = 8;

/** Times the tolerance. */
const kSilhouetteShare = 0.5;
const kHighlightEdges = 16;
const kColourEdges = 16;

/** From the east towards the north, over the ground. */
export function toLight({lightAzimuthDeg, lightHeightDeg}: TreeSettings): Vec3 {
  const [azimuth, height] = [lightAzimuthDeg, lightHeightDeg].map((deg) => (deg * Math.PI) / 180);
  const flat = Math.cos(height!);
  return [flat * Math.cos(azimuth!), flat * Math.sin(azimuth!), Math.sin(height!)];
}

export function criteriaOf(settings: TreeSettings): ViewCriteria {
  const {measure, tolerancePx, frustum, backFaces} = settings;
  return {
    measure,
    tolerancePx,
    frustum,
    backFaces,
    silhouettePx: settings.silhouettes ? kSilhouetteShare * tolerancePx : null,
    highlightPx: settings.highlight ? kHighlightEdges * tolerancePx : null,
    colourPx: settings.colours ? kColourEdges * tolerancePx : null,
    shininess: kShininess,
    toLight: toLight(settings),
  };
}
