/** Which curves are shown: chosen once, remembered by their names for every recording. */
import { signal, type Signal } from "@preact/signals";
import type { Curve, CurveList, MotionHead } from "../messages";
import type { Row } from "./drawing";

const KEY = "kineme.curves";
const FIRST = 8; // channels of signals that are shown before anybody chose
const ENDS = ["left_ankle", "right_ankle", "left_wrist", "right_wrist"]; // whose heights are shown

const chosen: Signal<string[]> = signal(remembered());

/** The joints of a body whose heights are shown before anybody chose: hands and feet. */
export function endsOf({ joints, effectors }: MotionHead): string[] {
  return ENDS.flatMap((part) => joints[effectors[part] ?? -1] ?? []);
}

/**
 * The rows to draw, in the order they were chosen; where none is known, the first channels, or the
 * heights of the joints `ends`.
 */
export function rowsOf(list: CurveList, ends: readonly string[]): Row[] {
  const all = list.curves.map((head, curve) => ({ curve, head }));
  const places = new Map(all.map((row) => [nameOf(row.head), row]));
  const found = chosen.value.flatMap((name) => places.get(name) ?? []);
  if (found.length) return found;
  const channels = all.filter(({ head }) => head.group === "channels");
  if (channels.length) return channels.slice(0, FIRST);
  return ends.flatMap((name) => places.get(nameOf({ name, group: "height", unit: "" })) ?? []);
}

/** Shows a curve, or hides it. */
export function toggle(list: CurveList, ends: readonly string[], curve: Curve): void {
  const shown = rowsOf(list, ends).map(({ head }) => nameOf(head));
  const name = nameOf(curve);
  const names = new Set(list.curves.map(nameOf));
  const others = chosen.value.filter((each) => !names.has(each)); // of other kinds of recordings
  const next = shown.includes(name) ? shown.filter((each) => each !== name) : [...shown, name];
  chosen.value = [...others, ...next];
  localStorage.setItem(KEY, JSON.stringify(chosen.value));
}

export function nameOf({ name, group }: Curve): string {
  return `${group}: ${name}`;
}

function remembered(): string[] {
  try {
    const found: unknown = JSON.parse(localStorage.getItem(KEY) ?? "[]");
    return Array.isArray(found) ? found.filter((each) => typeof each === "string") : [];
  } catch {
    return [];
  }
}
