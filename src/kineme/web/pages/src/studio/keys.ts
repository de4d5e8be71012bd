/** Define the keys that only the studio has. */
import type { StudioServices } from "./context";
import type { Editor } from "./editing/editor";
import type { Session } from "./session";

/** Keys and their actions, as the help shows them. */
export const STUDIO_KEYS: readonly (readonly [string, string])[] = [
  ["S", "Split at the playhead"],
  ["M", "Merge the segment with the next one"],
  ["Delete", "Delete the border nearest to the playhead"],
  ["[, ]", "The segment starts, or stops, at the playhead"],
  ["Alt + ← →", "Move the border nearest to the playhead by a frame; with Shift by ten"],
  ["A", "Work on activities, or on primitives again"],
  ["N", "Name the segment; Enter takes the name, Escape leaves it"],
  ["Shift + N", "Name its cluster"],
  ["1 … 9", "Name the segment with a label of the folder (see Segment)"],
  ["J", "Next to look at: where confidence is lowest"],
  ["K", "The segment is checked: mark it, and go to the next to look at"],
  ["Shift + K", "Mark the segment as checked, or take the mark away"],
  ["X", "Leave the selected repetition out of mean curves; once more brings it back"],
  ["Page Down, Page Up", "The next recording of the list, or the one before"],
  ["Ctrl + Z", "Undo"],
  ["Ctrl + Shift + Z", "Redo"],
  ["H", "Tables that were replaced"],
  ["T", "Labels from a knowledge base"],
  ["C", "Compare with another result"],
  ["E", "Export"],
  ["Escape", "Cancel the segmentation that is running, else dismiss what went wrong"],
  ["?", "This help"],
];

/** Return a key's command in the studio, or undefined. */
export function getStudioCommand(
  event: Pick<KeyboardEvent, "key" | "ctrlKey" | "metaKey" | "shiftKey" | "altKey">,
  { session, editor, review, view }: Omit<StudioServices, "uploads" | "poses">,
): (() => void) | undefined {
  const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
  if (event.ctrlKey || event.metaKey) {
    if (key === "z") return () => (event.shiftKey ? editor.redo() : editor.undo());
    return key === "y" ? () => editor.redo() : undefined;
  }
  if (event.altKey) {
    const by = { ArrowLeft: -1, ArrowRight: 1 }[key];
    return by ? () => editor.nudge(by * (event.shiftKey ? 10 : 1)) : undefined;
  }
  const digit = /^[1-9]$/.test(key) ? Number(key) : 0;
  if (digit) return () => nameByKey(digit, session, editor);
  const commands: Record<string, () => void> = {
    s: () => editor.split(),
    m: () => editor.mergeWithNext(),
    Delete: () => editor.deleteBorder(),
    Backspace: () => editor.deleteBorder(),
    a: () => session.store.toggleLevel(),
    n: () => editor.startNaming(event.shiftKey ? "cluster" : "segment"),
    "[": () => editor.moveBorderHere("start"),
    "]": () => editor.moveBorderHere("stop"),
    j: () => void review.goToNext(),
    k: () => (event.shiftKey ? review.toggleChecked() : review.checkAndGoOn()),
    x: () => editor.toggleExcluded(),
    PageDown: () => void session.openNext(1),
    PageUp: () => void session.openNext(-1),
    h: () => view.show("versions"),
    t: () => view.show("transfer"),
    c: () => view.show("compare"),
    e: () => view.show("export"),
    "?": () => view.show("help"),
  };
  if (session.segmenting.value) commands["Escape"] = () => session.cancel();
  else if (session.notifications.problems.value.length)
    commands["Escape"] = () => session.notifications.dismiss();
  return commands[key];
}

function nameByKey(digit: number, session: Session, editor: Editor): void {
  const label = session.state.value?.labels[digit - 1];
  if (label) editor.nameTarget(label);
  else
    session.notifications.tell(`No label is on the key ${digit} yet: add it in “Segment”, below.`);
}
