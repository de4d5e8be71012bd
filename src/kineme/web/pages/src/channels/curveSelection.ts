/** Remember which curves are shown, by name, for all recordings. */
import { signal, type Signal } from "@preact/signals";
import { readStored } from "../util";
import type { Curve, CurveList, MotionHead } from "../messages";
import type { Row } from "./drawing";

const STORAGE_KEY = "kineme.curves";
const MAX_DEFAULT_CHANNELS = 8;
const DEFAULT_EFFECTORS = ["left_ankle", "right_ankle", "left_wrist", "right_wrist"];

const chosen: Signal<string[]> = signal(loadChosen());

/** Return the names of the hand and foot joints, whose heights are shown by default. */
export function getDefaultJoints({ joints, effectors }: MotionHead): string[] {
  return DEFAULT_EFFECTORS.flatMap((part) => joints[effectors[part] ?? -1] ?? []);
}

/** Return the chosen curves; by default the first channels or the heights of the default joints. */
export function selectCurves(list: CurveList, defaultJoints: readonly string[]): Row[] {
  const all = list.curves.map((head, curve) => ({ curve, head }));
  const places = new Map(all.map((row) => [getCurveKey(row.head), row]));
  const found = chosen.value.flatMap((name) => places.get(name) ?? []);
  if (found.length) return found;
  const channels = all.filter(({ head }) => head.group === "channels");
  if (channels.length) return channels.slice(0, MAX_DEFAULT_CHANNELS);
  return defaultJoints.flatMap(
    (name) => places.get(getCurveKey({ name, group: "height", unit: "" })) ?? [],
  );
}

/** Show a hidden curve or hide a shown one. */
export function toggleCurve(list: CurveList, defaultJoints: readonly string[], curve: Curve): void {
  const shown = selectCurves(list, defaultJoints).map(({ head }) => getCurveKey(head));
  const name = getCurveKey(curve);
  const names = new Set(list.curves.map(getCurveKey));
  // Curves of other kinds of recordings stay selected.
  const others = chosen.value.filter((each) => !names.has(each));
  const next = shown.includes(name) ? shown.filter((each) => each !== name) : [...shown, name];
  chosen.value = [...others, ...next];
  localStorage.setItem(STORAGE_KEY, JSON.stringify(chosen.value));
}

export function getCurveKey({ name, group }: Curve): string {
  return `${group}: ${name}`;
}

function loadChosen(): string[] {
  const found = readStored(STORAGE_KEY);
  return Array.isArray(found) ? found.filter((each) => typeof each === "string") : [];
}
