/** List the repetitions of each activity and their durations. Pure functions. */
import type { Segment, Segments } from "../messages";
import { type Mean, computeMean } from "../mean";
import { getDuration, getLane } from "../segments";

/** An activity with its repetitions and the mean duration of those not excluded. */
export interface RepeatedActivity extends Mean {
  activity: Segment;
  /** Seconds of each repetition, in time order, and whether it is excluded. */
  durations: number[];
  leftOut: boolean[];
}

/** Return the activities that have repetitions, in time order. */
export function listRepetitions(table: Segments): RepeatedActivity[] {
  const inside = new Map<number, Segment[]>();
  for (const row of getLane(table, "primitive")) {
    if (row.kind !== "primitive") continue;
    const others = inside.get(row.activity);
    if (others) others.push(row);
    else inside.set(row.activity, [row]);
  }
  return getLane(table, "activity").flatMap((activity, number) => {
    const rows = inside.get(number) ?? [];
    if (activity.kind === "transition" || !rows.length) return [];
    const durations = rows.map(getDuration);
    const leftOut = rows.map((row) => row.excluded ?? false);
    const counted = durations.filter((_, i) => !leftOut[i]);
    return [{ activity, durations, leftOut, ...computeMean(counted) }];
  });
}
