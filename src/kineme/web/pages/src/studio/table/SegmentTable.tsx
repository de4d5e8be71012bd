/**
 * All segments as a table: ordered, filtered, several chosen at once. Only the rows that are seen
 * are there, so that ten thousand scroll like ten.
 */
import { counted } from "../../counted";
import { computed, useSignal, useSignalEffect } from "@preact/signals";
import type { JSX } from "preact";
import { useMemo, useRef } from "preact/hooks";
import { useStore } from "../../context";
import { NO_COLOR } from "../../colors";
import { durationOf, nameOf } from "../../segments";
import { clock } from "../../view";
import { between, EVERYTHING, type Filter, type Order, type Row, rowsOf } from "./rows";
import { Actions, LoopsButton } from "./Actions";
import { TableFilter } from "./TableFilter";
import { Button } from "../../layout/controls";

const HEIGHT = 26; // pixels of a row
const MORE = 6; // rows drawn above and below what is seen
const COLUMNS: readonly (readonly [Order, string])[] = [
  ["start", "Start"],
  ["duration", "Length"],
  ["name", "Name"],
  ["confidence", "Confidence"],
];

export function SegmentTable(): JSX.Element {
  const store = useStore();
  const filter = useSignal<Filter>(EVERYTHING);
  const order = useSignal<[Order, boolean]>(["start", false]);
  const chosen = useSignal<ReadonlySet<number>>(new Set());
  const anchor = useRef(0);
  const top = useSignal(0);
  const height = useSignal(400);
  const place = useRef<HTMLDivElement>(null);
  const rows = useMemo(
    () =>
      computed(() => {
        const table = store.table.value;
        return table ? rowsOf(table, filter.value, ...order.value) : [];
      }),
    [store, filter, order],
  );
  // What is chosen on the timeline is chosen here, too.
  useSignalEffect(() => {
    const selected = store.selected.value;
    const at = rows.peek().findIndex(({ segment }) => segment === selected);
    if (at < 0 || chosen.peek().has(rows.peek()[at]!.number)) return;
    chosen.value = new Set([rows.peek()[at]!.number]);
    anchor.current = at;
    scrollTo(place.current, at);
  });
  const go = (at: number, many: "one" | "range" | "more"): void => {
    const row = rows.value[Math.min(Math.max(at, 0), rows.value.length - 1)];
    if (!row) return;
    const index = rows.value.indexOf(row);
    if (many === "range")
      chosen.value = new Set(between(rows.value, anchor.current, index).map((each) => each.number));
    else {
      const before = many === "more" ? [...chosen.value] : [];
      const numbers = before.includes(row.number)
        ? before.filter((each) => each !== row.number)
        : [...before, row.number];
      chosen.value = new Set(numbers);
      anchor.current = index;
    }
    last.current = index;
    if (many !== "more") store.select(row.segment);
    scrollTo(place.current, index);
  };
  const last = useRef(0);
  const onKeyDown = (event: KeyboardEvent): void => {
    const by = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    const key = event.key.toLowerCase();
    if (by) go(last.current + by, event.shiftKey ? "range" : "one");
    else if (key === "a" && (event.ctrlKey || event.metaKey))
      chosen.value = new Set(rows.value.map((each) => each.number));
    else return;
    event.preventDefault();
    event.stopPropagation();
  };
  const many = rows.value.filter(({ number }) => chosen.value.has(number));
  const from = Math.max(Math.floor(top.value / HEIGHT) - MORE, 0);
  const to = Math.min(Math.ceil((top.value + height.value) / HEIGHT) + MORE, rows.value.length);
  return (
    <div class="segment-table">
      <TableFilter filter={filter} />
      {many.length > 0 && <Actions rows={many} />}
      <div class="table-head" role="presentation">
        {COLUMNS.map(([id, title]) => (
          <Button
            key={id}
            class="plain"
            title={`Order by ${title.toLowerCase()}`}
            onClick={() => (order.value = [id, order.value[0] === id && !order.value[1]])}
          >
            {title}
            {order.value[0] === id && (order.value[1] ? " ▾" : " ▴")}
          </Button>
        ))}
      </div>
      <div
        ref={(element) => {
          place.current = element;
          if (element) height.value = element.clientHeight || height.value;
        }}
        class="table-rows"
        role="grid"
        aria-label="Segments"
        aria-multiselectable="true"
        aria-rowcount={rows.value.length}
        tabIndex={0}
        onKeyDown={onKeyDown}
        onScroll={(event) => {
          top.value = event.currentTarget.scrollTop;
          height.value = event.currentTarget.clientHeight;
        }}
      >
        <div role="presentation" style={{ height: `${rows.value.length * HEIGHT}px` }}>
          {rows.value.slice(from, to).map((row, i) => (
            <TableRow
              key={row.number}
              row={row}
              at={from + i}
              color={store.colorOf(row.segment) ?? NO_COLOR}
              chosen={chosen.value.has(row.number)}
              go={go}
            />
          ))}
        </div>
      </div>
      <div class="table-foot">
        <p
          class="quiet note"
          role="status"
          title="Click rows, with Shift or Ctrl several, to name, merge, check or write them"
        >
          {counted(rows.value.length, "segment")}
          {many.length > 0 && `, ${many.length} chosen`}
        </p>
        <LoopsButton />
      </div>
    </div>
  );
}

function TableRow(props: {
  row: Row;
  at: number;
  color: string;
  chosen: boolean;
  go: (at: number, many: "one" | "range" | "more") => void;
}): JSX.Element {
  const { row, at, color, chosen, go } = props;
  const { segment, confidence } = row;
  return (
    <div
      role="row"
      class={segment.level}
      aria-selected={chosen}
      aria-rowindex={at + 1}
      style={{ top: `${at * HEIGHT}px` }}
      onClick={(event) =>
        go(at, event.shiftKey ? "range" : event.ctrlKey || event.metaKey ? "more" : "one")
      }
    >
      <span role="gridcell" class="number">
        {clock(segment.start_s, 2)}
      </span>
      <span role="gridcell" class="number">
        {durationOf(segment).toFixed(2)}
      </span>
      <span role="gridcell" class="name" title={`${segment.level}: ${nameOf(segment)}`}>
        <span class="swatch" style={{ background: color }} /> {nameOf(segment)}
      </span>
      <span role="gridcell" class="number">
        {segment.checked ? (
          <span title="checked">✓</span>
        ) : (
          <span title={confidence.why}>{confidence.short}</span>
        )}
      </span>
    </div>
  );
}

/** Brings a row into the view. */
function scrollTo(place: HTMLElement | null, at: number): void {
  if (!place) return;
  const { scrollTop, clientHeight } = place;
  if (at * HEIGHT < scrollTop) place.scrollTop = at * HEIGHT;
  else if ((at + 1) * HEIGHT > scrollTop + clientHeight)
    place.scrollTop = (at + 1) * HEIGHT - clientHeight;
}
