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

export function showLegend(look: Look, tileset: Tileset, tolerancePx: number): void {
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
    legend.ariaLabel = `Colours from ${low} to ${high}`;
  } else if (look === 'levels') {
    const swatches = part('swatches');
    swatches.append(...tileset.levels.map(({level, toleranceM}) => swatch(level, toleranceM)));
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

function swatch(level: number, toleranceM: number): HTMLElement {
  const made = document.createElement('span');
  const square = document.createElement('i');
  square.style.background = cssColor(levelColor(level));
  made.append(square, `${Number(toleranceM.toPrecision(3))} m`);
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
