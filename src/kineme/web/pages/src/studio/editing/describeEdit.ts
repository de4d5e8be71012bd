/** Describe edits for messages and the list of versions. */
import { formatCount } from "../../util";
import type { Edit, Level, Segments } from "../../messages";
import { formatCounts } from "../../segments";

const LEVELS: Record<Level, [one: string, many: string]> = {
  activity: ["activity", "activities"],
  primitive: ["primitive", "primitives"],
};

/** Return a description of an edit, times in seconds. */
export function describeEdit(edit: Edit, fps: number): string {
  const at = (frame: number) => `${(frame / fps).toFixed(2)} s`;
  switch (edit.kind) {
    case "move_border":
      return `${edit.level} border from ${at(edit.frame)} to ${at(edit.to)}`;
    case "split":
      return `${edit.level} split at ${at(edit.frame)}`;
    case "merge":
      return `${LEVELS[edit.level][1]} merged from ${at(edit.start_frame)} to ${at(edit.stop_frame)}`;
    case "delete_border":
      return `${edit.level} border at ${at(edit.frame)} deleted`;
    case "name_segment":
      return edit.label
        ? `${edit.level} at ${at(edit.frame)} named “${edit.label}”`
        : `own name of the ${edit.level} at ${at(edit.frame)} removed`;
    case "name_cluster":
      return edit.label
        ? `cluster ${edit.cluster} named “${edit.label}”`
        : `name of cluster ${edit.cluster} removed`;
    case "set_cluster":
      return edit.cluster < 0
        ? `${edit.level} at ${at(edit.frame)} removed from its cluster`
        : `${edit.level} at ${at(edit.frame)} put into cluster ${edit.cluster}`;
    case "set_kind":
      return edit.to === "transition"
        ? `${edit.level} at ${at(edit.frame)} made a transition`
        : `transition at ${at(edit.frame)} made ${edit.level === "activity" ? "an" : "a"} ${edit.level}`;
    case "merge_clusters":
      return `cluster ${edit.cluster} merged into ${edit.into}`;
    case "split_cluster":
      return `${formatCount(edit.frames.length, "segment")} of cluster ${edit.cluster} made a cluster of their own`;
    case "order_clusters":
      return "clusters put into another order";
    case "comment":
      return edit.text
        ? `comment on the ${edit.level} at ${at(edit.frame)}`
        : `comment on the ${edit.level} at ${at(edit.frame)} removed`;
    case "check":
      return `${formatCount(edit.frames.length, ...LEVELS[edit.level])} ${edit.checked ? "checked" : "not checked any more"}`;
    case "exclude":
      return `${formatCount(edit.frames.length, "repetition")} ${edit.excluded ? "left out of means" : "in means again"}`;
    case "together":
      return edit.edits.length === 1
        ? describeEdit(edit.edits[0]!, fps)
        : `${edit.edits.length} edits at once: ${edit.edits[0] ? describeEdit(edit.edits[0], fps) : ""}, …`;
    case "segment":
      return `segmented with ${edit.preset}`;
    case "take_labels":
      return `labels of another program taken as the table`;
    case "transfer":
      return `labels from a knowledge base`;
    case "restore":
      return `version ${edit.version} restored`;
    case "undo":
      return "undo";
    case "redo":
      return "redo";
  }
}

/** Return whether an edit replaces the whole table, which can be slow. */
export function replacesTable({ kind }: Edit): boolean {
  return ["segment", "transfer", "take_labels", "restore"].includes(kind);
}

/** Describe what a segmentation found and its duration; without timings it was cancelled. */
export function describeResult(table: Segments): string {
  if (!Object.keys(table.timings).length) return "Not segmented.";
  const seconds = Object.values(table.timings).reduce((sum, each) => sum + each, 0);
  return `${formatCounts(table)}, found in ${seconds.toFixed(2)} s.`;
}

export function isLossNote(note: string): boolean {
  return note.startsWith("not taken over");
}
