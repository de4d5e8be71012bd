/** How often each activity is repeated, and how long each repetition is. Pure functions. */
import type { Segment, Segments } from "../messages";
import { type Mean, meanOf } from "../mean";
import { durationOf, laneOf } from "../segments";

/** An activity with its repetitions, and the mean length of those that are not left out. */
export interface Repeated extends Mean {
  activity: Segment;
  /** Seconds of each repetition, in time order, and whether people left it out. */
  durations: number[];
  leftOut: boolean[];
}

/** The activities in time order; of those that nothing is known to repeat in, none. */
export function repetitionsOf(table: Segments): Repeated[] {
  const inside = new Map<number, Segment[]>();
  for (const row of laneOf(table, "primitive")) {
    if (row.kind !== "primitive") continue;
    const others = inside.get(row.activity);
    if (others) others.push(row);
    else inside.set(row.activity, [row]);
  }
  return laneOf(table, "activity").flatMap((activity, number) => {
    const rows = inside.get(number) ?? [];
    if (activity.kind === "transition" || !rows.length) return [];
    const durations = rows.map(durationOf);
    const leftOut = rows.map((row) => row.excluded ?? false);
    const counted = durations.filter((_, i) => !leftOut[i]);
    return [{ activity, durations, leftOut, ...meanOf(counted) }];
  });
}
