/** How often each activity is repeated, and how long each repetition is. Pure functions. */
import type { Segment, Segments } from "../messages";
import { durationOf, laneOf } from "../segments";

/** An activity with its repetitions. */
export interface Repeated {
  activity: Segment;
  /** Seconds of each repetition, in time order. */
  durations: number[];
  mean_s: number;
  /** Standard deviation, of two or more; null for one. */
  deviation_s: number | null;
}

/** The activities in time order; of those that nothing is known to repeat in, none. */
export function repetitionsOf(table: Segments): Repeated[] {
  const inside = new Map<number, number[]>();
  for (const row of laneOf(table, "primitive")) {
    if (row.kind !== "primitive") continue;
    const others = inside.get(row.activity);
    if (others) others.push(durationOf(row));
    else inside.set(row.activity, [durationOf(row)]);
  }
  return laneOf(table, "activity").flatMap((activity, number) => {
    const durations = inside.get(number) ?? [];
    if (activity.kind === "transition" || !durations.length) return [];
    const mean_s = durations.reduce((sum, each) => sum + each, 0) / durations.length;
    const squares = durations.reduce((sum, each) => sum + (each - mean_s) ** 2, 0);
    const deviation_s = durations.length > 1 ? Math.sqrt(squares / (durations.length - 1)) : null;
    return [{ activity, durations, mean_s, deviation_s }];
  });
}
