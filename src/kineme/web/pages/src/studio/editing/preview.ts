/**
 * What edits do to a table, shown at once while the server is still at it.
 *
 * A preview changes the rows of the level it names and nothing else; the
 * server's answer, where the other level follows, then takes its place.
 */

import type { Edit, Level, Segment, Segments } from "../../messages";

/** The table after the edits, in order; those that need the server change nothing. */
export function preview(table: Segments, edits: Edit[]): Segments {
  return edits.length
    ? { ...table, segments: edits.reduce(rowsAfter(table.fps), table.segments) }
    : table;
}

/** Whether the table shows the edit already: it was carried out, though nobody answered. */
export function isDone(edit: Edit, table: Segments): boolean {
  const rows = "level" in edit ? ofLevel(table.segments, edit.level) : table.segments;
  const startsAt = (frame: number) => rows.find((row) => row.start_frame === frame);
  switch (edit.kind) {
    case "move_border":
      return startsAt(edit.to) !== undefined && startsAt(edit.frame) === undefined;
    case "split":
      return startsAt(edit.frame) !== undefined;
    case "merge":
      return startsAt(edit.start_frame)?.stop_frame === edit.stop_frame;
    case "delete_border":
      return startsAt(edit.frame) === undefined;
    case "name_segment":
      return startsAt(edit.frame)?.label === edit.label;
    case "set_cluster":
      return startsAt(edit.frame)?.cluster === edit.cluster;
    case "set_kind":
      return startsAt(edit.frame)?.kind === edit.to;
    case "name_cluster":
      return rows.every((row) => row.cluster !== edit.cluster || row.label === edit.label);
    default:
      return false;
  }
}

/** A short text that is equal for tables with the same segments. */
export function fingerprint(table: Segments): string {
  let hash = 2166136261; // FNV-1a
  for (const row of table.segments) {
    const text = `${row.level}|${row.kind}|${row.start_frame}|${row.cluster}|${row.label}\n`;
    for (let i = 0; i < text.length; i++) hash = Math.imul(hash ^ text.charCodeAt(i), 16777619);
  }
  return `${table.n_frames}:${table.segments.length}:${hash >>> 0}`;
}

/** The rows of a level, in time order. */
export function ofLevel(rows: Segment[], level: Level): Segment[] {
  return rows.filter((row) => row.level === level);
}

/** The edit in words, its times in seconds. */
export function inWords(edit: Edit, fps: number): string {
  const at = (frame: number) => `${(frame / fps).toFixed(2)} s`;
  switch (edit.kind) {
    case "move_border":
      return `${edit.level} border from ${at(edit.frame)} to ${at(edit.to)}`;
    case "split":
      return `${edit.level} split at ${at(edit.frame)}`;
    case "merge":
      return `${edit.level} segments merged from ${at(edit.start_frame)} to ${at(edit.stop_frame)}`;
    case "delete_border":
      return `${edit.level} border at ${at(edit.frame)} deleted`;
    case "name_segment":
      return edit.label
        ? `${edit.level} at ${at(edit.frame)} named “${edit.label}”`
        : `name of the ${edit.level} at ${at(edit.frame)} removed`;
    case "name_cluster":
      return edit.label
        ? `cluster ${edit.cluster} named “${edit.label}”`
        : `name of cluster ${edit.cluster} removed`;
    case "set_cluster":
      return edit.cluster < 0
        ? `${edit.level} at ${at(edit.frame)} removed from its cluster`
        : `${edit.level} at ${at(edit.frame)} put into cluster ${edit.cluster}`;
    case "set_kind":
      return `${edit.level} at ${at(edit.frame)} made ${edit.to === "activity" ? "an" : "a"} ${edit.to}`;
    case "segment":
      return `segmented again with ${edit.preset}`;
    case "transfer":
      return `labels from ${edit.knowledge_base}`;
    case "undo":
      return "undo";
    case "redo":
      return "redo";
  }
}

function rowsAfter(fps: number): (rows: Segment[], edit: Edit) => Segment[] {
  const span = (row: Segment, start: number, stop: number): Segment => ({
    ...row,
    start_frame: start,
    stop_frame: stop,
    start_s: start / fps,
    stop_s: stop / fps,
  });
  const join = (rows: Segment[], first: number, last: number, like: number): Segment[] => [
    ...rows.slice(0, first),
    span(rows[like]!, rows[first]!.start_frame, rows[last]!.stop_frame),
    ...rows.slice(last + 1),
  ];
  return (rows, edit) => {
    if (edit.kind === "name_cluster")
      return rows.map((row) =>
        row.cluster === edit.cluster ? { ...row, label: edit.label } : row,
      );
    if (!("level" in edit)) return rows;
    const find = (test: (row: Segment) => boolean) =>
      rows.findIndex((row) => row.level === edit.level && test(row));
    const starting = (frame: number) => find((row) => row.start_frame === frame);
    const changed = (at: number, change: Partial<Segment>) =>
      at < 0 ? rows : rows.with(at, { ...rows[at]!, ...change });
    switch (edit.kind) {
      case "move_border": {
        const after = starting(edit.frame);
        const before = rows[after - 1];
        if (
          before?.level !== edit.level ||
          edit.to <= before.start_frame ||
          edit.to >= rows[after]!.stop_frame
        )
          return rows;
        return rows
          .with(after - 1, span(before, before.start_frame, edit.to))
          .with(after, span(rows[after]!, edit.to, rows[after]!.stop_frame));
      }
      case "split": {
        const at = find((row) => row.start_frame < edit.frame && edit.frame < row.stop_frame);
        const row = rows[at];
        if (!row) return rows;
        const halves = [
          span(row, row.start_frame, edit.frame),
          span(row, edit.frame, row.stop_frame),
        ];
        return rows.toSpliced(at, 1, ...halves);
      }
      case "merge": {
        const first = starting(edit.start_frame);
        const last = find((row) => row.stop_frame === edit.stop_frame);
        return first < 0 || last <= first ? rows : join(rows, first, last, first);
      }
      case "delete_border": {
        const after = starting(edit.frame);
        const [a, b] = [rows[after - 1], rows[after]];
        if (!a || !b || a.level !== b.level) return rows;
        const longer = frames(b) > frames(a) ? after : after - 1;
        return join(rows, after - 1, after, longer);
      }
      case "name_segment":
        return changed(starting(edit.frame), { label: edit.label });
      case "set_cluster":
        return changed(
          starting(edit.frame),
          edit.cluster < 0 ? { cluster: -1 } : { cluster: edit.cluster, kind: "activity" },
        );
      case "set_kind":
        return changed(
          starting(edit.frame),
          edit.to === "transition" ? { kind: "transition", cluster: -1 } : { kind: "activity" },
        );
    }
  };
}

function frames(row: Segment): number {
  return row.stop_frame - row.start_frame;
}
