/** Choose how fine the segments are. */
import type { JSX } from "preact";
import { useStore } from "../context";
import { findDetailIndex } from "../store";

export function DetailSlider(): JSX.Element | null {
  const store = useStore();
  const levels = store.levels.value;
  if (!levels || levels.all.length < 2) return null;
  const { all, detail, choose } = levels;
  const description = detail === 1 ? "as usual" : detail < 1 ? "coarser" : "finer";
  return (
    <label class="detail" title="How fine the segments are (comma coarser, full stop finer)">
      <span>
        Detail <span class="quiet">{description}</span>
      </span>
      <span class="number">{Number(detail.toFixed(3))}</span>
      <input
        type="range"
        aria-label="Detail"
        aria-valuetext={`${detail}, ${description}`}
        min={0}
        max={all.length - 1}
        step={1}
        value={findDetailIndex(detail, all)}
        onInput={(event) => choose(all[event.currentTarget.valueAsNumber]!)}
      />
    </label>
  );
}
