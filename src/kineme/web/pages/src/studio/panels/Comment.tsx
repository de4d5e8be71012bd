/** What people say about the segment. */
import type { JSX } from "preact";
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
  return (
    <label class="field">
      <span>Comment</span>
      <textarea
        key={text}
        rows={2}
        placeholder="what others should know of it"
        defaultValue={text}
        onKeyDown={(event) => {
          if (event.key === "Escape") event.currentTarget.value = text;
          if (event.key === "Escape" || (event.key === "Enter" && event.ctrlKey))
            event.currentTarget.blur();
        }}
        onBlur={(event) => {
          const now = event.currentTarget.value.trim();
          if (now !== text) editor.comment(segment, now);
        }}
      />
    </label>
  );
}

function isIn(frame: number, segment: Segment): boolean {
  return segment.start_frame <= frame && frame < segment.stop_frame;
}
