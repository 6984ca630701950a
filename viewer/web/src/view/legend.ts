// What the colours of a look mean.
import type {Look} from '../core/settings';
import type {Tileset} from '../core/tileset';
import {
  cssColor,
  cssGradient,
  kLargestErrorShare,
  kSteepestDeg,
  levelColor,
  rampOf,
} from './color_ramps';
import {element} from './page';
import {kWater, kWaterOnMaps} from './water_shader';

export function showLegend(
  look: Look,
  tileset: Tileset,
  {tolerancePx, hasWater}: {readonly tolerancePx: number; readonly hasWater: boolean},
): void {
  const legend = element('legend');
  const ramp = rampOf(look);
  legend.hidden = !ramp && look !== 'levels';
  if (ramp) {
    const [low, high] = endsOf(look, tileset, tolerancePx);
    const bar = part('bar');
    bar.style.background = cssGradient(ramp);
    const ends = part('ends');
    ends.append(span(low), span(high));
    legend.replaceChildren(bar, ends);
    const water = look === 'relief' ? kWater : kWaterOnMaps;
    if (hasWater && look !== 'error') legend.append(swatch(water, 'Water'));
    legend.ariaLabel = `Colours from ${low} to ${high}`;
  } else if (look === 'levels') {
    const swatches = part('swatches');
    const text = (metres: number) => `${Number(metres.toPrecision(3))} m`;
    swatches.append(
      ...tileset.levels.map(({level, toleranceM}) => swatch(levelColor(level), text(toleranceM))),
    );
    legend.replaceChildren(swatches);
    legend.ariaLabel = 'A colour for each level of detail';
  }
}

function endsOf(look: Look, {minHeightM, maxHeightM}: Tileset, tolerancePx: number) {
  if (look === 'slope') return ['0°', `${kSteepestDeg}°`] as const;
  if (look === 'error')
    return ['0 px', `${(kLargestErrorShare * tolerancePx).toFixed(1)} px`] as const;
  const metres = (value: number) => `${Math.round(value).toLocaleString('en')} m`;
  return [metres(minHeightM), metres(maxHeightM)] as const;
}

function swatch(color: number, text: string): HTMLElement {
  const made = document.createElement('span');
  const square = document.createElement('i');
  square.style.background = cssColor(color);
  made.append(square, text);
  return made;
}

function part(className: string): HTMLElement {
  const made = document.createElement('div');
  made.className = className;
  return made;
}

function span(text: string): HTMLElement {
  const made = document.createElement('span');
  made.textContent = text;
  return made;
}
