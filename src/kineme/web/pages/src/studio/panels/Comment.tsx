/** What people say about the segment. */
import type { JSX } from "preact";
import { useDraft } from "../../layout/draft";
import { useStudio } from "../context";
import type { Segment } from "../../messages";

interface Props {
  segment: Segment;
}

export function Comment({ segment }: Props): JSX.Element {
  const { session, editor } = useStudio();
  const comments = session.store.table.value?.comments ?? [];
  const text = comments
    .filter(({ level, frame }) => level === segment.level && isIn(frame, segment))
    .map((each) => each.text)
    .join("\n");
  const draft = useDraft(text, (now) => editor.comment(segment, now.trim()));
  return (
    <label class="field">
      <span>Comment</span>
      <textarea rows={2} placeholder="what others should know of it" {...draft} />
    </label>
  );
}

function isIn(frame: number, segment: Segment): boolean {
  return segment.start_frame <= frame && frame < segment.stop_frame;
}
