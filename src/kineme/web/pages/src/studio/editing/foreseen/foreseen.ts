/** What an edit will make of a table, before the server has said so. */
import type { ByHand, Edit, Segment, Segments } from "../../../messages";
import { deleteBorder, merge, moveBorder, split } from "./borders";
import { mergeClusters, orderClusters, setCluster, setKind, splitCluster } from "./clusters";
import { nameCluster, nameSegment, namesIn } from "./names";
import { check, comment, commentsIn, exclude, markedIn, noted } from "./notes";
import { allRows, draftOf, Impossible, type Draft } from "./rows";

/**
 * The table after an edit; as it is where the edit cannot be made, and null where only the server
 * knows, which segments anew and has the tables that were replaced.
 */
export function foreseen(table: Segments, edit: Edit): Segments | null {
  const edits = edit.kind === "together" ? edit.edits : [edit];
  if (!edits.every(isByHand)) return null;
  try {
    return tableOf(table, edits.reduce(afterOne, draftOf(table)));
  } catch (error) {
    if (error instanceof Impossible) return table;
    throw error;
  }
}

function isByHand(edit: Edit): edit is ByHand {
  const others = ["segment", "take_labels", "transfer", "restore", "undo", "redo", "together"];
  return !others.includes(edit.kind);
}

function afterOne(draft: Draft, edit: ByHand): Draft {
  const after = made(draft, edit);
  return ["check", "comment", "exclude"].includes(edit.kind) ? after : noted(draft, after);
}

function made(draft: Draft, edit: ByHand): Draft {
  switch (edit.kind) {
    case "move_border":
      return moveBorder(draft, edit.level, edit.frame, edit.to);
    case "split":
      return split(draft, edit.level, edit.frame);
    case "merge":
      return merge(draft, edit.level, edit.start_frame, edit.stop_frame);
    case "delete_border":
      return deleteBorder(draft, edit.level, edit.frame);
    case "name_segment":
      return nameSegment(draft, edit.level, edit.frame, edit.label);
    case "name_cluster":
      return nameCluster(draft, edit.cluster, edit.label);
    case "set_cluster":
      return setCluster(draft, edit.level, edit.frame, edit.cluster);
    case "set_kind":
      return setKind(draft, edit.level, edit.frame, edit.to);
    case "merge_clusters":
      return mergeClusters(draft, edit.cluster, edit.into);
    case "split_cluster":
      return splitCluster(draft, edit.cluster, edit.frames);
    case "order_clusters":
      return orderClusters(draft, edit.order);
    case "comment":
      return comment(draft, edit.level, edit.frame, edit.text);
    case "check":
      return check(draft, edit.level, edit.frames, edit.checked);
    case "exclude":
      return exclude(draft, edit.frames, edit.excluded);
  }
}

/** The message of a table, with what follows from its rows and its annotation. */
export function tableOf(before: Segments, draft: Draft): Segments {
  const segments = [...allRows(draft)];
  const numbered = (marked: ReadonlySet<Segment>): number[] => {
    const numbers: number[] = [];
    segments.forEach((row, i) => marked.has(row) && numbers.push(i));
    return numbers;
  };
  return {
    ...before,
    annotation: draft.annotation,
    segments,
    cluster_names: Object.fromEntries([...namesIn(draft)].filter(([, name]) => name)),
    checked: numbered(markedIn(draft, "checked")),
    by_hand: numbered(markedIn(draft, "by_hand")),
    comments: commentsIn(draft).map(([level, frame, text]) => ({ level, frame, text })),
  };
}
