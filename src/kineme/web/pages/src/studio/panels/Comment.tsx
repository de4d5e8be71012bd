/** Edit the comment on a segment. */
import type { JSX } from "preact";
import { useDraft } from "../../layout/useDraft";
import { useStudio } from "../context";
import type { Segment, Segments } from "../../messages";
import { getTarget } from "../editing/commands";

interface Props {
  segment: Segment;
  /** Table that contains the segment. */
  table: Segments | undefined;
}

export function Comment({ segment, table }: Props): JSX.Element {
  const { editor } = useStudio();
  const draft = useDraft(segment.comment ?? "", (now) =>
    editor.edit({ kind: "comment", ...getTarget(segment), text: now.trim() }, table),
  );
  return (
    <label class="field">
      <span>Comment</span>
      <textarea rows={2} placeholder="what others should know of it" {...draft} />
    </label>
  );
}
