/** List, filter and edit all segments. */
import { formatCount } from "../../util";
import { computed, signal, useSignal, useSignalEffect, type Signal } from "@preact/signals";
import { useMemo, useRef } from "preact/hooks";
import { findRow, getDuration, getSegmentName } from "../../segments";
import { formatTime } from "../../view";
import {
  NO_FILTER,
  findSpansToMerge,
  listRows,
  sliceRows,
  type Filter,
  type Order,
  type Row,
} from "./rows";
import { OrderButton, useVisibleRows, type ColumnOrder } from "../../layout/tables";
import {
  Button,
  Form,
  Select,
  Swatch,
  TextInput,
  toggleMember,
  useBusy,
} from "../../layout/controls";
import { useStudio } from "../context";
import type { ByHand } from "../../messages";
import { getTarget } from "../editing/edits";
import { saveFile } from "../server/api";

const ROW_HEIGHT = 26; // pixels of a row
const COLUMNS: readonly (readonly [Order, string])[] = [
  ["start", "Start"],
  ["duration", "Length"],
  ["name", "Name"],
  ["confidence", "Confidence"],
];

export function SegmentTable() {
  const { session, view } = useStudio();
  const { store } = session;
  const filter = useSignal<Filter>(NO_FILTER);
  const order = useSignal<ColumnOrder<Order>>(["start", false]);
  const chosen = useSignal<ReadonlySet<number>>(new Set());
  const anchor = useRef(0);
  const { ref, onScroll, from, to } = useVisibleRows(ROW_HEIGHT);
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
    scrollToRow(ref.current, at);
  });
  const chooseRow = (at: number, many: "one" | "range" | "more"): void => {
    const row = rows.value[Math.min(Math.max(at, 0), rows.value.length - 1)];
    if (!row) return;
    const index = rows.value.indexOf(row);
    if (many === "range") {
      const range = sliceRows(rows.value, anchor.current, index);
      chosen.value = new Set(range.map((each) => each.number));
    } else {
      chosen.value = toggleMember(many === "more" ? chosen.value : new Set(), row.number);
      anchor.current = index;
    }
    last.current = index;
    if (many !== "more") store.select(row.segment);
    scrollToRow(ref.current, index);
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
  return (
    <div class="segment-table">
      <TableFilter filter={filter} />
      {many.length > 0 && <RowActions rows={many} />}
      <div class="table-head" role="presentation">
        {COLUMNS.map(([id, title]) => (
          <OrderButton
            key={id}
            order={order}
            column={id}
            title={title}
            tooltip={`Order by ${title.toLowerCase()}`}
          />
        ))}
      </div>
      <div
        ref={ref}
        class="table-rows"
        role="grid"
        aria-label="Segments"
        aria-multiselectable="true"
        aria-rowcount={rows.value.length}
        tabIndex={0}
        onKeyDown={onKeyDown}
        onScroll={onScroll}
      >
        <div role="presentation" style={{ height: `${rows.value.length * ROW_HEIGHT}px` }}>
          {rows.value.slice(from, to).map((row, i) => (
            <TableRow
              key={row.number}
              row={row}
              at={from + i}
              color={store.getColor(row.segment)}
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
        <Button
          disabled={!session.edited.value || !store.recording.value?.motion}
          title="Which repetitions make good loops: seam, sliding feet, turn and speed"
          onClick={() => view.show("loops")}
        >
          Loops by quality…
        </Button>
      </div>
    </div>
  );
}

function TableRow(props: {
  row: Row;
  at: number;
  color: string | null;
  chosen: boolean;
  go: (at: number, many: "one" | "range" | "more") => void;
}) {
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

/** Filter the table of segments. */
function TableFilter({ filter }: { filter: Signal<Filter> }) {
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
      {open.value && <MoreFilters filter={filter.value} change={change} />}
    </div>
  );
}

function MoreFilters(props: { filter: Filter; change: (part: Partial<Filter>) => void }) {
  const { filter, change } = props;
  return (
    <div class="more-filters">
      <Select
        label="Kind of segment"
        value={filter.kind}
        options={KINDS}
        onSelect={(kind) => change({ kind })}
      />
      <Select
        label="Checked or not"
        value={filter.checked}
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
            defaultValue={filter[key] === NO_FILTER[key] ? "" : filter[key]}
            onInput={({ currentTarget: { valueAsNumber: value } }) =>
              change({ [key]: Number.isFinite(value) ? value : NO_FILTER[key] })
            }
          />
        ))}
      </span>
    </div>
  );
}

function RowActions({ rows }: { rows: Row[] }) {
  const { session, editor } = useStudio();
  const [busy, run] = useBusy();
  const exportClips = async (loops: boolean): Promise<void> => {
    const edited = session.edited.value;
    if (!edited) return;
    await session.notifications.attempt("clips", async () => {
      await edited.waitUntilSent(); // pending edits may move rows
      const { segmentation } = edited.confirmed.value;
      const present = rows.map(({ segment }) => findRow(segmentation, segment));
      const numbers = present.map((row) => segmentation.segments.indexOf(row!));
      const there = numbers.filter((number) => number >= 0);
      saveFile(await session.api.exportClips(edited.id, { rows: there, loops }));
    });
  };
  const cluster = rows[0]?.segment.cluster ?? -1;
  const divisible =
    cluster >= 0 &&
    rows.every(
      ({ segment }) => segment.cluster === cluster && segment.level === rows[0]?.segment.level,
    );
  const name = useSignal("");
  const merges = findSpansToMerge(rows);
  const checked = rows.length > 0 && rows.every(({ segment }) => segment.checked);
  const segments = rows.map(({ segment }) => segment);
  return (
    <div class="table-actions">
      <Form
        onSubmit={() => {
          const label = name.value.trim();
          const edits = segments.map((each): ByHand => {
            return { kind: "name_segment", ...getTarget(each), label };
          });
          editor.sendTogether(edits, `named “${label}”`);
        }}
      >
        <TextInput aria-label="Name for all chosen" placeholder="name" value={name} />
        <Button type="submit">Name {rows.length}</Button>
      </Form>
      <Button
        disabled={!merges.length}
        title="Neighbours become one segment"
        onClick={() =>
          editor.sendTogether(
            merges.map(({ level, start, stop }) => {
              return { kind: "merge", level, start_frame: start, stop_frame: stop };
            }),
            "merged",
          )
        }
      >
        Merge
      </Button>
      <Button onClick={() => editor.setChecked(segments, !checked)}>
        {checked ? "Uncheck" : "Check"}
      </Button>
      <Button
        disabled={!divisible}
        title="The chosen ones become a cluster of their own"
        onClick={() =>
          editor.edit({
            kind: "split_cluster",
            cluster,
            frames: segments.map(({ start_frame }) => start_frame),
          })
        }
      >
        New cluster
      </Button>
      <Button
        disabled={busy !== ""}
        title="The chosen segments as motion files"
        onClick={() => void run("clips", () => exportClips(false))}
      >
        Clips…
      </Button>
      <Button
        disabled={busy !== ""}
        title="The same, each made to close, so that it can be repeated without a jerk"
        onClick={() => void run("loops", () => exportClips(true))}
      >
        Loops…
      </Button>
    </div>
  );
}
