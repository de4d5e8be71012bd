/** List the curves to choose from, with a search field. */
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import type { CurveList } from "../messages";
import { getCurveKey, selectCurves, toggleCurve } from "./curveSelection";
import { Checkbox, TextInput } from "../layout/controls";

interface Props {
  list: CurveList;
  /** Joints whose heights are shown by default. */
  defaultJoints: readonly string[];
}

export function ChannelChoice({ list, defaultJoints }: Props): JSX.Element {
  const search = useSignal("");
  const shown = new Set(selectCurves(list, defaultJoints).map(({ curve }) => curve));
  const words = search.value.toLowerCase().split(/\s+/);
  const found = list.curves
    .map((head, curve) => ({ head, curve }))
    .filter(({ head }) => words.every((word) => getCurveKey(head).toLowerCase().includes(word)));
  const groups = [...new Set(found.map(({ head }) => head.group))];
  return (
    <details class="channel-choice">
      <summary>Curves…</summary>
      <div class="channel-list">
        <TextInput
          type="search"
          placeholder="Search: height foot"
          aria-label="Search the curves"
          value={search}
        />
        {groups.map((group) => (
          <fieldset key={group}>
            <legend class="quiet">{group}</legend>
            {found
              .filter(({ head }) => head.group === group)
              .map(({ head, curve }) => (
                <Checkbox
                  key={curve}
                  checked={shown.has(curve)}
                  onCheck={() => toggleCurve(list, defaultJoints, head)}
                >
                  {head.name}
                </Checkbox>
              ))}
          </fieldset>
        ))}
        {!found.length && <p class="quiet">No curve has that name.</p>}
      </div>
    </details>
  );
}
