/** Assign one colour to each cluster, as `kineme._colors` does. */

const PALETTE = [
  "#332288",
  "#DDCC77",
  "#117733",
  "#CC6677",
  "#88CCEE",
  "#882255",
  "#999933",
  "#44AA99",
  "#AA4499",
] as const;
/** Colour of segments without cluster and label. */
export const NO_COLOR = "#DDDDDD";
const MIXES = [
  { share: 0, grey: 0 },
  { share: 0.5, grey: 255 },
  { share: 0.4, grey: 0 },
] as const;

const COLORS = MIXES.flatMap(({ share, grey }) =>
  PALETTE.map((color) =>
    formatColor(
      parseColor(color).map((channel) => roundHalfToEven((1 - share) * channel + share * grey)),
    ),
  ),
);

/** Return a cluster's colour as `#RRGGBB`; grey for -1 (no cluster). */
export function getClusterColor(cluster: number): string {
  return cluster < 0 ? NO_COLOR : COLORS[cluster % COLORS.length]!;
}

/**
 * Return a colour for each label: that of its most frequent cluster, so that a label looks the same
 * in two compared results; without a cluster, one derived from the text.
 */
export function assignLabelColors(
  rows: readonly { label: string; cluster: number; start_s: number; stop_s: number }[],
): Map<string, string> {
  const most = new Map<string, Map<number, number>>();
  for (const { label, cluster, start_s, stop_s } of rows) {
    if (!label) continue;
    const seconds = most.get(label) ?? new Map<number, number>();
    most.set(label, seconds);
    if (cluster >= 0) seconds.set(cluster, (seconds.get(cluster) ?? 0) + stop_s - start_s);
  }
  const used = new Set(rows.map(({ cluster }) => getClusterColor(cluster)));
  const colors = new Map<string, string>();
  for (const label of [...most.keys()].sort()) {
    const [first] = [...most.get(label)!].sort((a, b) => b[1] - a[1]);
    const color = first ? getClusterColor(first[0]) : pickFreeColor(label, used);
    used.add(color);
    colors.set(label, color);
  }
  return colors;
}

/** Return a colour derived from a text, avoiding used ones if possible. */
function pickFreeColor(text: string, used: ReadonlySet<string>): string {
  let hash = 2166136261; // FNV-1a
  for (let i = 0; i < text.length; i++) hash = Math.imul(hash ^ text.charCodeAt(i), 16777619);
  hash >>>= 0;
  for (let i = 0; i < COLORS.length; i++) {
    const color = getClusterColor(hash + i);
    if (!used.has(color)) return color;
  }
  return getClusterColor(hash);
}

/** Return black or white, whichever contrasts more with a colour. */
export function getTextColor(color: string): "#000000" | "#FFFFFF" {
  const l = computeLuminance(color);
  return 1.05 / (l + 0.05) >= (l + 0.05) / 0.05 ? "#FFFFFF" : "#000000";
}

/** Lighten dark colours on a dark page and darken light colours on a light page. */
export function adaptColor(color: string, theme: "dark" | "light"): string {
  const l = computeLuminance(color);
  const dark = theme === "dark";
  const share = dark ? Math.max(0, 0.45 - 3 * l) : Math.max(0, 0.6 * (l - 0.55));
  const mixed = parseColor(color).map((c) =>
    Math.round((1 - share) * c + share * (dark ? 255 : 0)),
  );
  return formatColor(mixed);
}

/** Return the relative luminance from 0 (black) to 1 (white), as WCAG defines it. */
export function computeLuminance(color: string): number {
  const [r, g, b] = parseColor(color).map((channel) => {
    const c = channel / 255;
    return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
  }) as [number, number, number];
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

/** Return red, green and blue from 0 to 255. */
export function parseColor(color: string): [number, number, number] {
  const at = (i: number): number => parseInt(color.slice(i, i + 2), 16);
  return [at(1), at(3), at(5)];
}

function formatColor(channels: readonly number[]): string {
  return "#" + channels.map((c) => c.toString(16).padStart(2, "0").toUpperCase()).join("");
}

/** Round half to even, as Python does. */
function roundHalfToEven(value: number): number {
  const floor = Math.floor(value);
  if (value - floor !== 0.5) return Math.round(value);
  return floor % 2 === 0 ? floor : floor + 1;
}
