/** Tables of recordings that are not open, as the folder tells them. Pure functions. */
import { bareSegment, type BriefTable, type Segment, type Segments } from "../../messages";
import { clusterColor, labelColors, NO_COLOR } from "../../colors";
import { checkedIn, laneOf } from "../../segments";
import { doubtsOf, type Doubt } from "../review/doubts";

/** Half a doubt: what is of less confidence is counted. */
export const HALF = 0.5;

/** A table as every page has it, from its columns. */
export function tableOf(brief: BriefTable): Segments {
  const { fps, n_frames } = brief;
  const checked = new Set(brief.checked);
  const segments = brief.level.map((level, row): Segment => ({
    ...bareSegment,
    level,
    kind: brief.kind[row]!,
    start_frame: brief.start_frame[row]!,
    stop_frame: brief.stop_frame[row]!,
    start_s: brief.start_frame[row]! / fps,
    stop_s: brief.stop_frame[row]! / fps,
    cluster: brief.cluster[row]!,
    activity: brief.activity[row]!,
    label: brief.label[row]!,
    confidence: brief.confidence[row]!,
    border_confidence: brief.border_confidence[row]!,
    checked: checked.has(row),
  }));
  return { schema: "", n_frames, fps, provenance: {}, timings: {}, segments, cluster_names: {} };
}

/** How far a table is: its rows, those checked, and those left of less confidence than half. */
export interface Tally {
  all: number;
  checked: number;
  doubtful: number;
}

/** The queue of a table, as `doubtsOf`, once for each. */
export function queueOf(table: Segments): readonly Doubt[] {
  return kept(queues, table, () => doubtsOf(table));
}

export function tallyOf(table: Segments): Tally {
  const doubtful = queueOf(table).filter(({ value }) => value !== null && value < HALF).length;
  return { all: table.segments.length, checked: checkedIn(table), doubtful };
}

/** The least confidence of what is not checked; null where there is none. */
export function leastOf(table: Segments): number | null {
  return queueOf(table)[0]?.value ?? null;
}

/** The activities, or primitives where activities are in no cluster, as colours of a gradient. */
export function stripOf(table: Segments): string {
  return kept(strips, table, () => {
    const activities = laneOf(table, "activity");
    const hasColors = activities.some(({ cluster, label }) => cluster >= 0 || label);
    const lane = hasColors ? activities : laneOf(table, "primitive");
    const colors = labelColors(lane);
    const stops = lane.map(({ cluster, label, start_frame, stop_frame }) => {
      const color = cluster >= 0 ? clusterColor(cluster) : (colors.get(label) ?? NO_COLOR);
      const share = (frame: number): string => `${((100 * frame) / table.n_frames).toFixed(2)}%`;
      return `${color} ${share(start_frame)} ${share(stop_frame)}`;
    });
    return stops.length ? `linear-gradient(to right, ${stops.join(", ")})` : "none";
  });
}

const queues = new WeakMap<Segments, readonly Doubt[]>();
const strips = new WeakMap<Segments, string>();

function kept<Value>(cache: WeakMap<Segments, Value>, of: Segments, make: () => Value): Value {
  const found = cache.get(of) ?? make();
  cache.set(of, found);
  return found;
}
