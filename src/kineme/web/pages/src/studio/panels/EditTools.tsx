/** The buttons that cut and join, for those without a keyboard at hand. */
import type { JSX } from "preact";
import { useStore } from "../../context";
import type { Level } from "../../messages";
import { useStudio } from "../context";
import { deleteBorder, mergeWithNext } from "../editing/commands";
import { Button } from "../../layout/controls";

const LEVELS: readonly (readonly [Level, string])[] = [
  ["activity", "Activities"],
  ["primitive", "Primitives"],
];

export function EditTools(): JSX.Element {
  const store = useStore();
  const { editor } = useStudio();
  const disabled = !editor.segment.value;
  const where = { lane: store.lane(store.worked.value), frame: store.frame.value };
  return (
    <>
      <span class="group" role="group" aria-label="Work on">
        {LEVELS.map(([level, name]) => (
          <Button
            key={level}
            aria-pressed={store.worked.value === level}
            disabled={!store.lane(level).length}
            title={`Work on ${name.toLowerCase()} (A)`}
            onClick={() => store.workOn(level)}
          >
            {name}
          </Button>
        ))}
      </span>
      <span class="group edit-tools" role="group" aria-label="Segments">
        <Button
          disabled={disabled}
          title="A border at the playhead (S)"
          onClick={() => editor.split()}
        >
          Split
        </Button>
        <Button
          disabled={!mergeWithNext(where)}
          title="The segment and the next one become one (M)"
          onClick={() => editor.mergeWithNext()}
        >
          Merge
        </Button>
        <Button
          disabled={!deleteBorder(where)}
          title="Delete the border nearest to the playhead (Delete)"
          onClick={() => editor.deleteBorder()}
        >
          Delete border
        </Button>
      </span>
    </>
  );
}
