/** One colour per cluster, the same as in `kineme._colors`. */

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
/** Of what is in no cluster and has no label. */
export const NO_COLOR = "#DDDDDD";
const MIXES = [
  { share: 0, grey: 0 },
  { share: 0.5, grey: 255 },
  { share: 0.4, grey: 0 },
] as const;

const COLORS = MIXES.flatMap(({ share, grey }) =>
  PALETTE.map((color) =>
    hex(channelsOf(color).map((channel) => halfToEven((1 - share) * channel + share * grey))),
  ),
);

/** `#RRGGBB` of a cluster; grey for -1, which is none. */
export function clusterColor(cluster: number): string {
  return cluster < 0 ? NO_COLOR : COLORS[cluster % COLORS.length]!;
}

/**
 * The colour of each label: that of the cluster that has it most, so that a label looks the same
 * in two results that are compared; else one made from the text itself.
 */
export function labelColors(
  rows: readonly { label: string; cluster: number; start_s: number; stop_s: number }[],
): Map<string, string> {
  const most = new Map<string, Map<number, number>>();
  for (const { label, cluster, start_s, stop_s } of rows) {
    if (!label) continue;
    const seconds = most.get(label) ?? new Map<number, number>();
    most.set(label, seconds);
    if (cluster >= 0) seconds.set(cluster, (seconds.get(cluster) ?? 0) + stop_s - start_s);
  }
  const used = new Set(rows.map(({ cluster }) => clusterColor(cluster)));
  const colors = new Map<string, string>();
  for (const label of [...most.keys()].sort()) {
    const [first] = [...most.get(label)!].sort((a, b) => b[1] - a[1]);
    const color = first ? clusterColor(first[0]) : freeColor(label, used);
    used.add(color);
    colors.set(label, color);
  }
  return colors;
}

/** A colour for a text, the same on every day; another one where that is taken. */
function freeColor(text: string, used: ReadonlySet<string>): string {
  let hash = 2166136261; // FNV-1a
  for (let i = 0; i < text.length; i++) hash = Math.imul(hash ^ text.charCodeAt(i), 16777619);
  hash >>>= 0;
  for (let i = 0; i < COLORS.length; i++) {
    const color = clusterColor(hash + i);
    if (!used.has(color)) return color;
  }
  return clusterColor(hash);
}

/** Black or white, whichever is easier to read on a colour. */
export function inkOn(color: string): "#000000" | "#FFFFFF" {
  const l = luminance(color);
  return 1.05 / (l + 0.05) >= (l + 0.05) / 0.05 ? "#FFFFFF" : "#000000";
}

/** A colour that shows on the page: the darkest ones lighter where the page is dark, and vice versa. */
export function onPage(color: string, theme: "dark" | "light"): string {
  const l = luminance(color);
  const dark = theme === "dark";
  const share = dark ? Math.max(0, 0.45 - 3 * l) : Math.max(0, 0.6 * (l - 0.55));
  const mixed = channelsOf(color).map((c) =>
    Math.round((1 - share) * c + share * (dark ? 255 : 0)),
  );
  return hex(mixed);
}

/** Relative luminance from 0 (black) to 1 (white), as WCAG defines it. */
export function luminance(color: string): number {
  const [r, g, b] = channelsOf(color).map((channel) => {
    const c = channel / 255;
    return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
  }) as [number, number, number];
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

/** Red, green and blue from 0 to 255. */
export function channelsOf(color: string): [number, number, number] {
  const at = (i: number): number => parseInt(color.slice(i, i + 2), 16);
  return [at(1), at(3), at(5)];
}

function hex(channels: readonly number[]): string {
  return "#" + channels.map((c) => c.toString(16).padStart(2, "0").toUpperCase()).join("");
}

/** Python's way of rounding, so that both sides agree to the last digit. */
function halfToEven(value: number): number {
  const floor = Math.floor(value);
  if (value - floor !== 0.5) return Math.round(value);
  return floor % 2 === 0 ? floor : floor + 1;
}
