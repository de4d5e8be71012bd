/** List all segments; only visible rows are rendered, so long lists scroll fast. */
import { formatCount } from "../../formatCount";
import { computed, useSignal, useSignalEffect } from "@preact/signals";
import type { JSX } from "preact";
import { useMemo, useRef } from "preact/hooks";
import { useStore } from "../../context";
import { NO_COLOR } from "../../colors";
import { getDuration, getSegmentName } from "../../segments";
import { formatTime } from "../../view";
import { sliceRows, NO_FILTER, type Filter, type Order, type Row, listRows } from "./rows";
import { RowActions, LoopsButton } from "./RowActions";
import { TableFilter } from "./TableFilter";
import { Button, Swatch } from "../../layout/controls";

const ROW_HEIGHT = 26; // pixels of a row
const OVERSCAN = 6; // rows rendered above and below the visible ones
const COLUMNS: readonly (readonly [Order, string])[] = [
  ["start", "Start"],
  ["duration", "Length"],
  ["name", "Name"],
  ["confidence", "Confidence"],
];

export function SegmentTable(): JSX.Element {
  const store = useStore();
  const filter = useSignal<Filter>(NO_FILTER);
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
        return table ? listRows(table, filter.value, ...order.value) : [];
      }),
    [store, filter, order],
  );
  // Select the row of the segment selected on the timeline.
  useSignalEffect(() => {
    const selected = store.selected.value;
    const at = rows.peek().findIndex(({ segment }) => segment === selected);
    if (at < 0 || chosen.peek().has(rows.peek()[at]!.number)) return;
    chosen.value = new Set([rows.peek()[at]!.number]);
    anchor.current = at;
    scrollToRow(place.current, at);
  });
  const chooseRow = (at: number, many: "one" | "range" | "more"): void => {
    const row = rows.value[Math.min(Math.max(at, 0), rows.value.length - 1)];
    if (!row) return;
    const index = rows.value.indexOf(row);
    if (many === "range")
      chosen.value = new Set(
        sliceRows(rows.value, anchor.current, index).map((each) => each.number),
      );
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
    scrollToRow(place.current, index);
  };
  const last = useRef(0);
  const onKeyDown = (event: KeyboardEvent): void => {
    const by = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    const key = event.key.toLowerCase();
    if (by) chooseRow(last.current + by, event.shiftKey ? "range" : "one");
    else if (key === "a" && (event.ctrlKey || event.metaKey))
      chosen.value = new Set(rows.value.map((each) => each.number));
    else return;
    event.preventDefault();
    event.stopPropagation();
  };
  const many = rows.value.filter(({ number }) => chosen.value.has(number));
  const from = Math.max(Math.floor(top.value / ROW_HEIGHT) - OVERSCAN, 0);
  const to = Math.min(
    Math.ceil((top.value + height.value) / ROW_HEIGHT) + OVERSCAN,
    rows.value.length,
  );
  return (
    <div class="segment-table">
      <TableFilter filter={filter} />
      {many.length > 0 && <RowActions rows={many} />}
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
        <div role="presentation" style={{ height: `${rows.value.length * ROW_HEIGHT}px` }}>
          {rows.value.slice(from, to).map((row, i) => (
            <TableRow
              key={row.number}
              row={row}
              at={from + i}
              color={store.getColor(row.segment) ?? NO_COLOR}
              chosen={chosen.value.has(row.number)}
              go={chooseRow}
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
          {formatCount(rows.value.length, "segment")}
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
      style={{ top: `${at * ROW_HEIGHT}px` }}
      onClick={(event) =>
        go(at, event.shiftKey ? "range" : event.ctrlKey || event.metaKey ? "more" : "one")
      }
    >
      <span role="gridcell" class="number">
        {formatTime(segment.start_s, 2)}
      </span>
      <span role="gridcell" class="number">
        {getDuration(segment).toFixed(2)}
      </span>
      <span role="gridcell" class="name" title={`${segment.level}: ${getSegmentName(segment)}`}>
        <Swatch color={color} /> {getSegmentName(segment)}
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

/** Scroll to a row. */
function scrollToRow(place: HTMLElement | null, at: number): void {
  if (!place) return;
  const { scrollTop, clientHeight } = place;
  if (at * ROW_HEIGHT < scrollTop) place.scrollTop = at * ROW_HEIGHT;
  else if ((at + 1) * ROW_HEIGHT > scrollTop + clientHeight)
    place.scrollTop = (at + 1) * ROW_HEIGHT - clientHeight;
}
