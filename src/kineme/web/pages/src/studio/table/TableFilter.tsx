/** Filter the table of segments. */
import { signal, type Signal } from "@preact/signals";
import type { JSX } from "preact";

import { NO_FILTER, type Filter } from "./rows";
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
const NUMBERS = [
  ["shortest", "from s", "Shortest, seconds", "0.1"],
  ["longest", "to s", "Longest, seconds", "0.1"],
  ["confidenceBelow", "confidence <", "Confidence below", "0.05"],
] as const;
/** Whether all filters are shown. */
const open = signal(false);

export function TableFilter({ filter }: { filter: Signal<Filter> }): JSX.Element {
  const change = (part: Partial<Filter>): void =>
    void (filter.value = { ...filter.value, ...part });
  const { text, level, ...rest } = filter.value;
  const narrowed = Object.entries(rest).some(
    ([what, value]) => value !== NO_FILTER[what as keyof typeof rest],
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
        {NUMBERS.map(([key, placeholder, label, step]) => (
          <input
            key={key}
            type="number"
            min="0"
            step={step}
            max={key === "confidenceBelow" ? 1 : ""}
            placeholder={placeholder}
            aria-label={label}
            defaultValue={filter.value[key] === NO_FILTER[key] ? "" : filter.value[key]}
            onInput={({ currentTarget: { valueAsNumber: value } }) =>
              change({ [key]: Number.isFinite(value) ? value : NO_FILTER[key] })
            }
          />
        ))}
      </span>
    </div>
  );
}
