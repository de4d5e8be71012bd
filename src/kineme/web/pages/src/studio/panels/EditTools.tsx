/** The buttons that cut and join, for those without a keyboard at hand. */
import type { JSX } from "preact";
import { useStudio } from "../context";

export function EditTools(): JSX.Element {
  const { editor } = useStudio();
  const disabled = !editor.segment.value;
  return (
    <span class="group edit-tools" role="group" aria-label="Segments">
      <button
        type="button"
        disabled={disabled}
        title="A border at the playhead (S)"
        onClick={() => editor.split()}
      >
        Split
      </button>
      <button
        type="button"
        disabled={disabled}
        title="The segment and the next one become one (M)"
        onClick={() => editor.mergeWithNext()}
      >
        Merge
      </button>
      <button
        type="button"
        disabled={disabled}
        title="Delete the border nearest to the playhead (Delete)"
        onClick={() => editor.deleteBorder()}
      >
        Delete border
      </button>
    </span>
  );
}
