/** The list of curves to choose from: search, then tick. */
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import type { CurveList } from "../messages";
import { nameOf, rowsOf, toggle } from "./chosen";
import { Checkbox } from "../layout/controls";

interface Props {
  list: CurveList;
  /** The joints shown before anybody chose. */
  ends: readonly string[];
}

export function ChannelChoice({ list, ends }: Props): JSX.Element {
  const search = useSignal("");
  const shown = new Set(rowsOf(list, ends).map(({ curve }) => curve));
  const words = search.value.toLowerCase().split(/\s+/);
  const found = list.curves
    .map((head, curve) => ({ head, curve }))
    .filter(({ head }) => words.every((word) => nameOf(head).toLowerCase().includes(word)));
  const groups = [...new Set(found.map(({ head }) => head.group))];
  return (
    <details class="channel-choice">
      <summary>Curves…</summary>
      <div class="channel-list">
        <input
          type="search"
          placeholder="Search: height foot"
          aria-label="Search the curves"
          value={search.value}
          onInput={(event) => (search.value = event.currentTarget.value)}
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
                  onCheck={() => toggle(list, ends, head)}
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
