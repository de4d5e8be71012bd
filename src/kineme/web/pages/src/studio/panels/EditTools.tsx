/** Offer buttons to split, merge and delete. */
import type { JSX } from "preact";
import { useStore } from "../../context";
import type { Level } from "../../messages";
import { useStudio } from "../context";
import { createDeletion, createMerge } from "../editing/commands";
import { Button } from "../../layout/controls";

const LEVELS: readonly (readonly [Level, string])[] = [
  ["activity", "Activities"],
  ["primitive", "Primitives"],
];

export function EditTools(): JSX.Element {
  const store = useStore();
  const { editor } = useStudio();
  const disabled = !editor.segment.value;
  const where = { lane: store.getLane(store.workLevel.value), frame: store.frame.value };
  return (
    <>
      <span class="group" role="group" aria-label="Work on">
        {LEVELS.map(([level, name]) => (
          <Button
            key={level}
            aria-pressed={store.workLevel.value === level}
            disabled={!store.getLane(level).length}
            title={`Work on ${name.toLowerCase()} (A)`}
            onClick={() => store.setLevel(level)}
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
          disabled={!createMerge(where)}
          title="The segment and the next one become one (M)"
          onClick={() => editor.mergeWithNext()}
        >
          Merge
        </Button>
        <Button
          disabled={!createDeletion(where)}
          title="Delete the border nearest to the playhead (Delete)"
          onClick={() => editor.deleteBorder()}
        >
          Delete border
        </Button>
      </span>
    </>
  );
}
