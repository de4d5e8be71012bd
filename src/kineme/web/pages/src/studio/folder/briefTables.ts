/** Unpack and summarise tables of recordings that are not open. Pure functions. */
import { bareSegment, type BriefTable, type Segment, type Segments } from "../../messages";
import { getClusterColor, assignLabelColors, NO_COLOR } from "../../colors";
import { memoize } from "../../util";
import { countChecked, getLane } from "../../segments";
import { listDoubts } from "../../confidence";

/** Segments with a lower confidence count as doubtful. */
const DOUBT_LIMIT = 0.5;

/** Build a segment table from its columns. */
export function unpackTable(brief: BriefTable): Segments {
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

/** Numbers of rows: all, checked, and unchecked with low confidence. */
export interface Tally {
  all: number;
  checked: number;
  doubtful: number;
}

/** Return the cached doubts of a table. */
export const getDoubts = memoize(listDoubts);

export function computeTally(table: Segments): Tally {
  const doubtful = getDoubts(table).filter(
    ({ confidence: { value } }) => value !== null && value < DOUBT_LIMIT,
  ).length;
  return { all: table.segments.length, checked: countChecked(table), doubtful };
}

/** Return the lowest confidence of the unchecked segments; null if there is none. */
export function getLowestConfidence(table: Segments): number | null {
  return getDoubts(table)[0]?.confidence.value ?? null;
}

/** Return a CSS gradient of the activities' colours; of the primitives' if activities have none. */
export const getStrip = memoize((table: Segments): string => {
  const activities = getLane(table, "activity");
  const hasColors = activities.some(({ cluster, label }) => cluster >= 0 || label);
  const lane = hasColors ? activities : getLane(table, "primitive");
  const colors = assignLabelColors(lane);
  const stops = lane.map(({ cluster, label, start_frame, stop_frame }) => {
    const color = cluster >= 0 ? getClusterColor(cluster) : (colors.get(label) ?? NO_COLOR);
    const share = (frame: number): string => `${((100 * frame) / table.n_frames).toFixed(2)}%`;
    return `${color} ${share(start_frame)} ${share(stop_frame)}`;
  });
  return stops.length ? `linear-gradient(to right, ${stops.join(", ")})` : "none";
});
