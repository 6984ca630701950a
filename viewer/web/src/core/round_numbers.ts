// Numbers that people like to read: 1, 2 or 5 times a power of ten.

/** The largest round number that is not above a value above 0. */
export function roundBelow(value: number): number {
  const power = 10 ** Math.floor(Math.log10(value));
  const digit = value / power;
  return (digit >= 5 ? 5 : digit >= 2 ? 2 : 1) * power;
}

/** The smallest round number that is not below a value above 0. */
export function roundAbove(value: number): number {
  const below = roundBelow(value);
  if (below >= value) return below;
  const digit = Math.round(below / 10 ** Math.floor(Math.log10(below)));
  return digit === 2 ? below * 2.5 : below * 2;
}

/** Made once: that takes as long as many numbers do. */
const kEnglish = new Intl.NumberFormat('en');

/** Metres, or kilometres from a thousand on. */
export function lengthText(metres: number): string {
  const [value, unit] = Math.abs(metres) >= 1000 ? [metres / 1000, 'km'] : [metres, 'm'];
  const digits = Math.abs(value) >= 100 ? 0 : Math.abs(value) >= 10 ? 1 : 2;
  return `${kEnglish.format(Number(value.toFixed(digits)))} ${unit}`;
}

/** Bytes as people say them. */
export function bytesText(bytes: number): string {
  return bytes >= 1e6 ? `${(bytes / 1e6).toFixed(1)} MB` : `${Math.round(bytes / 1e3)} kB`;
}
