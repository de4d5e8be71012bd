/** What the table of segments is narrowed to. */
import { signal, type Signal } from "@preact/signals";
import type { JSX } from "preact";

import { EVERYTHING, type Filter } from "./rows";
import { Button, Select } from "../../layout/controls";

const LEVELS = [
  ["", "both levels"],
  ["activity", "activities"],
  ["primitive", "primitives"],
] as const;
const KINDS = [
  ["", "every kind"],
  ["movement", "no transitions"],
  ["transition", "transitions"],
] as const;
const CHECKED = [
  ["", "checked or not"],
  ["no", "not checked"],
  ["yes", "checked"],
] as const;
/** Whether more is shown than name and level. */
const open = signal(false);

export function TableFilter({ filter }: { filter: Signal<Filter> }): JSX.Element {
  const change = (part: Partial<Filter>): void =>
    void (filter.value = { ...filter.value, ...part });
  const { text, level, ...rest } = filter.value;
  const narrowed = Object.entries(rest).some(
    ([what, value]) => value !== EVERYTHING[what as keyof typeof rest],
  );
  return (
    <div class="table-filter">
      <input
        type="search"
        placeholder="Name or cluster"
        aria-label="Only segments with this in their name"
        value={text}
        onInput={(event) => change({ text: event.currentTarget.value })}
      />
      <Select
        label="Level"
        value={level}
        options={LEVELS}
        onSelect={(chosen) => change({ level: chosen })}
      />
      <Button
        aria-expanded={open.value}
        aria-pressed={narrowed}
        title="Kind, checked or not, length, confidence"
        onClick={() => (open.value = !open.value)}
      >
        More
      </Button>
      {open.value && <MoreFilters filter={filter} />}
    </div>
  );
}

function MoreFilters({ filter }: { filter: Signal<Filter> }): JSX.Element {
  const change = (part: Partial<Filter>): void =>
    void (filter.value = { ...filter.value, ...part });
  const number = (text: string, otherwise: number): number => {
    const value = Number.parseFloat(text);
    return Number.isFinite(value) ? value : otherwise;
  };
  const { shortest, longest, confidenceBelow } = filter.value;
  return (
    <div class="more-filters">
      <Select
        label="Kind of segment"
        value={filter.value.kind}
        options={KINDS}
        onSelect={(kind) => change({ kind })}
      />
      <Select
        label="Checked or not"
        value={filter.value.checked}
        options={CHECKED}
        onSelect={(checked) => change({ checked })}
      />
      <span class="group">
        <input
          type="number"
          min="0"
          step="0.1"
          placeholder="from s"
          aria-label="Shortest, seconds"
          defaultValue={shortest || ""}
          onInput={(event) => change({ shortest: number(event.currentTarget.value, 0) })}
        />
        <input
          type="number"
          min="0"
          step="0.1"
          placeholder="to s"
          aria-label="Longest, seconds"
          defaultValue={Number.isFinite(longest) ? longest : ""}
          onInput={(event) => change({ longest: number(event.currentTarget.value, Infinity) })}
        />
        <input
          type="number"
          min="0"
          max="1"
          step="0.05"
          placeholder="confidence <"
          aria-label="Confidence below"
          defaultValue={Number.isFinite(confidenceBelow) ? confidenceBelow : ""}
          onInput={(event) =>
            change({ confidenceBelow: number(event.currentTarget.value, Infinity) })
          }
        />
      </span>
    </div>
  );
}
