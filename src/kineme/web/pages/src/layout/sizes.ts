/** Store the sizes of panels, which the user can change. */
import { readStored } from "./browser";
import { signal, type Signal } from "@preact/signals";

/** A panel's size in pixels; null for the default. */
export interface Size {
  name: string;
  title: string;
  minimum: number;
  pixels: Signal<number | null>;
}

const STORAGE_KEY = "kineme.sizes";
const stored = (readStored(STORAGE_KEY) ?? {}) as Record<string, number | null>;

function createSize(name: string, title: string, minimum: number): Size {
  return { name, title, minimum, pixels: signal(stored[name] ?? null) };
}

export const SIZES = {
  left: createSize("left", "recordings and segmentation", 150),
  matrix: createSize("matrix", "matrix", 160),
  side: createSize("side", "side panel", 220),
  timeline: createSize("timeline", "timeline", 110),
  curves: createSize("curves", "curves", 70),
};

/** Return the changed sizes as CSS variables of the layout. */
export function getSizeStyle(): Record<string, string> {
  return Object.fromEntries(
    Object.values(SIZES).flatMap(({ name, pixels }) =>
      pixels.value === null ? [] : [[`--${name}`, `${pixels.value}px`]],
    ),
  );
}

/** Set a size between the minimum and `most` pixels; null restores the default. */
export function setSize(
  { name, minimum, pixels }: Size,
  extent: number | null,
  most: number,
): void {
  pixels.value = extent === null ? null : Math.round(Math.min(Math.max(extent, minimum), most));
  stored[name] = pixels.value;
  localStorage.setItem(STORAGE_KEY, JSON.stringify(stored));
}
