/** What people say about the segment. */
import type { JSX } from "preact";
import { useDraft } from "../../layout/draft";
import { useStudio } from "../context";
import type { Segment, Segments } from "../../messages";
import { placeOf } from "../editing/commands";

interface Props {
  segment: Segment;
  /** What the segment is a row of. */
  table: Segments | undefined;
}

export function Comment({ segment, table }: Props): JSX.Element {
  const { editor } = useStudio();
  const draft = useDraft(segment.comment ?? "", (now) =>
    editor.edit({ kind: "comment", ...placeOf(segment), text: now.trim() }, table),
  );
  return (
    <label class="field">
      <span>Comment</span>
      <textarea rows={2} placeholder="what others should know of it" {...draft} />
    </label>
  );
}
