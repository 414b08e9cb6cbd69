// Colours of the canvases, from the style sheet: asked for again when the scheme changes.
let kept: Record<string, string> = {};
matchMedia('(prefers-color-scheme: light)').addEventListener('change', () => { kept = {}; });

export function color(name: string): string {
  return kept[name] ??= getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

// cividis: read with any colour vision, and brighter is stiffer.
const STOPS: [number, number, number][] = [[0, 34, 78], [53, 69, 108], [102, 105, 112], [148, 142, 119], [200, 184, 102], [254, 232, 56]];
export function cividis(share: number): string {
  const x = Math.min(0.999, Math.max(0, share)) * 5, i = Math.floor(x), f = x - i, a = STOPS[i]!, b = STOPS[i + 1]!;
  return `rgb(${a.map((p, k) => Math.round(p + (b[k]! - p) * f)).join(',')})`;
}
