/** How large the panels are: dragged or set with keys, and remembered. */
import { signal, type Signal } from "@preact/signals";

/** A panel's size in pixels; null: as the page has it. */
export interface Size {
  name: string;
  title: string;
  least: number;
  pixels: Signal<number | null>;
}

const KEY = "kineme.sizes";
const stored = remembered();

function size(name: string, title: string, least: number): Size {
  return { name, title, least, pixels: signal(stored[name] ?? null) };
}

export const SIZES = {
  left: size("left", "recordings and segmentation", 150),
  matrix: size("matrix", "matrix", 160),
  side: size("side", "side panel", 220),
  timeline: size("timeline", "timeline", 110),
  curves: size("curves", "curves", 70),
};

/** Those that were set, as CSS variables of the layout. */
export function sizeStyle(): Record<string, string> {
  return Object.fromEntries(
    Object.values(SIZES).flatMap(({ name, pixels }) =>
      pixels.value === null ? [] : [[`--${name}`, `${pixels.value}px`]],
    ),
  );
}

/** Sets a size within what the page has room for; null: as the page has it. */
export function setSize({ name, least, pixels }: Size, extent: number | null, most: number): void {
  pixels.value = extent === null ? null : Math.round(Math.min(Math.max(extent, least), most));
  stored[name] = pixels.value;
  localStorage.setItem(KEY, JSON.stringify(stored));
}

function remembered(): Record<string, number | null> {
  try {
    const found: unknown = JSON.parse(localStorage.getItem(KEY) ?? "{}");
    return found && typeof found === "object" ? (found as Record<string, number | null>) : {};
  } catch {
    return {};
  }
}
