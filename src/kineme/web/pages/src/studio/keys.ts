/** The keys of the studio, beyond those of every page. */
import type { DialogName } from "./Header";
import type { Editor } from "./editing/editor";

/** Keys and what they do, as the help shows them. */
export const STUDIO_KEYS: readonly (readonly [string, string])[] = [
  ["S", "Split at the playhead"],
  ["M", "Merge the segment with the next one"],
  ["Delete", "Delete the border nearest to the playhead"],
  ["Alt + ← →", "Move the border nearest to the playhead by a frame; with Shift by ten"],
  ["N", "Name the segment; Enter takes the name, Escape leaves it"],
  ["Shift + N", "Name all segments of its cluster"],
  ["Ctrl + Z", "Undo"],
  ["Ctrl + Shift + Z", "Redo"],
  ["T", "Labels from a knowledge base"],
  ["C", "Compare with another result"],
  ["E", "Export"],
  ["?", "This help"],
];

/** What a key does in the studio; undefined where it does nothing. */
export function commandOf(
  event: Pick<KeyboardEvent, "key" | "ctrlKey" | "metaKey" | "shiftKey" | "altKey">,
  editor: Editor,
  show: (dialog: DialogName) => void,
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
  const commands: Record<string, () => void> = {
    s: () => editor.split(),
    m: () => editor.mergeWithNext(),
    Delete: () => editor.deleteBorder(),
    Backspace: () => editor.deleteBorder(),
    n: () => (editor.naming.value = event.shiftKey ? "cluster" : "segment"),
    t: () => show("transfer"),
    c: () => show("compare"),
    e: () => show("export"),
    "?": () => show("help"),
  };
  return commands[key];
}
