/** How often each activity is repeated, and how long each repetition is. Pure functions. */
import type { Segment, Segments } from "../messages";
import { durationOf, laneOf } from "../segments";

/** An activity with its repetitions. */
export interface Repeated {
  activity: Segment;
  /** Seconds of each repetition, in time order, and whether people left it out. */
  durations: number[];
  leftOut: boolean[];
  /** Of those that are not left out; null where there are none. */
  mean_s: number | null;
  /** Standard deviation, of two or more; null for one. */
  deviation_s: number | null;
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

function meanOf(values: readonly number[]): Pick<Repeated, "mean_s" | "deviation_s"> {
  if (!values.length) return { mean_s: null, deviation_s: null };
  const mean_s = values.reduce((sum, each) => sum + each, 0) / values.length;
  const squares = values.reduce((sum, each) => sum + (each - mean_s) ** 2, 0);
  return {
    mean_s,
    deviation_s: values.length > 1 ? Math.sqrt(squares / (values.length - 1)) : null,
  };
}
