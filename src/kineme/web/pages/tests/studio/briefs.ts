/** Create brief tables of a folder. */
import type { BriefTable, Listing, Segments } from "../../src/messages";
import { createTable, segment } from "../recordings";

/** Create two activities; the second border has this confidence. */
export function brief(border: number, checked: number[] = []): BriefTable {
  const activity = { level: "activity", confidence: 1 } as const;
  const rows = [
    segment(0, 40, { ...activity, activity: 0 }),
    segment(40, 100, {
      ...activity,
      ...{ activity: 1, cluster: 1, label: "hop", border_confidence: border },
    }),
  ];
  return createBrief(createTable(rows.map((row, i) => ({ ...row, checked: checked.includes(i) }))));
}

export function listing(id: string, table: BriefTable | null): Listing {
  const n = table?.level.length ?? 0;
  const checked = table?.checked.length ?? 0;
  return {
    id,
    file: id,
    name: `${id}.bvh`,
    bytes: 1,
    needs_poses: false,
    corrected: table !== null,
    segments: n,
    checked,
    named: table?.label.filter(Boolean).length ?? 0,
    to_name: n,
  };
}

/** Return a table as the server sends it. */
export function createBrief({ n_frames, fps, segments }: Segments): BriefTable {
  return {
    n_frames,
    fps,
    level: segments.map(({ level }) => level),
    kind: segments.map(({ kind }) => kind),
    start_frame: segments.map(({ start_frame }) => start_frame),
    stop_frame: segments.map(({ stop_frame }) => stop_frame),
    cluster: segments.map(({ cluster }) => cluster),
    activity: segments.map(({ activity }) => activity),
    label: segments.map(({ label }) => label),
    confidence: segments.map(({ confidence }) => confidence),
    border_confidence: segments.map(({ border_confidence }) => border_confidence),
    checked: segments.flatMap(({ checked }, row) => (checked ? [row] : [])),
    comments: segments.filter(({ comment }) => comment).length,
  };
}
