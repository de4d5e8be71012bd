/** List all recordings of the folder; only visible rows are rendered. */
import { formatCount, listen } from "../../util";
import { computed, useSignal, useSignalEffect } from "@preact/signals";
import { useEffect, useLayoutEffect, useMemo, useRef } from "preact/hooks";
import { isPlayerKey } from "../../page";
import { AddFiles, TruncatedName } from "./FolderPanel";
import { useStudio } from "../context";
import { PosesOffer } from "../panels/PosesOffer";
import { OrderButton, useVisibleRows, type ColumnOrder } from "../../layout/tables";
import { STATUSES, STATUS_ORDER, type Status } from "./recordingList";
import { FolderProgress } from "../review/ReviewPanel";
import { Button, Select, TextInput } from "../../layout/controls";
import type { ComponentChildren } from "preact";
import { countSegments, getSegmentKey, getSegmentName } from "../../segments";
import { formatTime } from "../../view";
import { computeTally, getDoubts, getLowestConfidence, getStrip, type Tally } from "./briefTables";
import type { FolderMember } from "./folder";

const COVERED = ".layout > :not(.place-header)";
const [ROW_HEIGHT, LOW_ROW_HEIGHT] = [30, 26]; // pixels; the lower one is for low windows
const LOW_WINDOW = 480; // pixels, as in folder.css
const HEADER_BOTTOM = 40; // pixels, if the header has one line and no notices above

export function FolderPage() {
  const { session, view } = useStudio();
  const files = new Set(session.state.value?.recordings.map((each) => each.file));
  const several = files.size > 1;
  // The viewer asks a question.
  const asks = session.question.value !== "" || session.videoWithoutPoses.value;
  const none = !session.store.opened.value.length && !session.opening.value && !asks;
  if (!(view.folder.value ?? (several && none))) return null;
  return <Page />;
}

function Page() {
  const { session, review, view } = useStudio();
  const { folder } = review;
  const { list } = session;
  const order = useSignal<ColumnOrder<Column>>(["name", false]);
  const width = useSignal(Infinity);
  const head = useSignal(HEADER_BOTTOM);
  const rowHeight = innerHeight > LOW_WINDOW ? ROW_HEIGHT : LOW_ROW_HEIGHT;
  const { ref, onScroll, from, to } = useVisibleRows(rowHeight);
  const rows = useMemo(
    () =>
      computed(() => {
        const found = folder.members.value.filter(({ listing }) => list.matches(listing));
        const all = found.map((each) => createRow(each, list.getStatus(each.listing)));
        return sortRows(all, ...order.value);
      }),
    [folder, list, order],
  );
  useEffect(() => {
    void folder.refresh();
    const bar = document.querySelector(".place-header");
    scrollTo(0, 0); // on small screens the header scrolls as well
    const sized = new ResizeObserver(() => {
      width.value = ref.current?.clientWidth ?? Infinity;
      head.value = bar?.getBoundingClientRect().bottom ?? HEADER_BOTTOM;
    });
    for (const each of [ref.current, bar, document.querySelector(".notices")])
      if (each) sized.observe(each);
    return () => sized.disconnect();
  }, [folder, ref, width, head]);
  useOverlay();
  const columns = fitColumns(COLUMNS, width.value);
  const [widths, least] = getGrid(columns);
  const grid = {
    "--columns": widths,
    "--least": `${least}px`,
    "--row": `${rowHeight}px`,
    "--head": `${head.value}px`,
  };
  const isOpen = session.store.opened.value.length > 0;
  return (
    <section class="folder-page" aria-label="Folder" style={grid}>
      <div class="folder-tools">
        <h2>{session.state.value?.folder.split(/[\\/]/).at(-1)}</h2>
        <FolderProgress tally={folder.tally.value} />
        <span class="spacer" />
        <AddFiles />
        <SegmentAllButton />
        <Button
          class="primary"
          title="Through all recordings, what has the lowest confidence first (J)"
          onClick={() => void review.setEverywhere(true)}
        >
          Review all recordings
        </Button>
        {isOpen && (
          <Button onClick={() => (view.folder.value = null)}>Back to the recording</Button>
        )}
      </div>
      <PosesOffer all />
      <div class="folder-tools">
        <TextInput
          type="search"
          placeholder="Filter by name"
          aria-label="Filter the recordings by name"
          value={list.search}
        />
        <Select
          label="Recordings that are"
          value={list.status.value}
          options={STATUSES}
          onSelect={(chosen) => (list.status.value = chosen)}
        />
        <span class="quiet number" role="status">
          {rows.value.length} of {folder.members.value.length} recordings
        </span>
      </div>
      <div
        ref={ref}
        class="folder-rows"
        role="table"
        aria-label="Recordings of the folder"
        aria-rowcount={rows.value.length + 1}
        tabIndex={0}
        onScroll={onScroll}
      >
        <div role="row" class="folder-row folder-head" aria-rowindex={1}>
          {columns.map(({ id, title, help }) => {
            const [by, reverse] = order.value;
            const sorted = by === id ? (reverse ? "descending" : "ascending") : "none";
            return (
              <span key={id} role="columnheader" aria-sort={sorted}>
                <OrderButton
                  order={order}
                  column={id}
                  title={title}
                  tooltip={`${help}; order by it`}
                />
              </span>
            );
          })}
        </div>
        <div role="rowgroup" style={{ height: `${rows.value.length * rowHeight}px` }}>
          {rows.value.slice(from, to).map((row, i) => (
            <FolderRow
              key={row.listing.id}
              row={row}
              at={from + i}
              top={(from + i) * rowHeight}
              columns={columns.map(({ id }) => id)}
            />
          ))}
        </div>
      </div>
    </section>
  );
}

/** Disable the covered page, and close the overlay when another recording opens. */
function useOverlay(): void {
  const { session, review, view } = useStudio();
  const { store } = session;
  const first = useRef(true);
  useSignalEffect(() => {
    void [store.recording.value?.id, review.queue.current.value];
    if (!first.current) view.folder.value = null;
    first.current = false;
  });
  useLayoutEffect(() => {
    const below = [...document.querySelectorAll<HTMLElement>(COVERED)];
    for (const each of below) each.inert = true;
    const onKey = (event: KeyboardEvent): void => {
      if (!store.recording.peek() || document.querySelector("dialog[open]")) return;
      event.stopPropagation();
      if (event.key === "Escape") view.folder.value = null;
      if (event.key === "j" && isPlayerKey(event)) void review.setEverywhere(true);
    };
    const stopListening = listen(window, { keydown: onKey }, { capture: true });
    return () => {
      for (const each of below) each.inert = false;
      stopListening();
    };
  }, [store, review, view]);
}

/** Segment all recordings without segments and show the progress. */
function SegmentAllButton() {
  const { review } = useStudio();
  const { folder } = review;
  const { value: finding } = folder.segmenting;
  const { length: n } = folder.unsegmented.value;
  if (finding)
    return (
      <span class="quiet number" role="status">
        <span class="busy" /> segmenting {finding.done + 1} of {finding.all}…
      </span>
    );
  if (!n || !folder.isReady.value) return null;
  return (
    <Button
      title="Find the segments of the recordings that have none yet; they are saved once you edit them"
      onClick={() => void folder.segmentAll()}
    >
      Segment {formatCount(n, "recording")}
    </Button>
  );
}

const MAX_PLACES = 2;

/** Columns of the folder table: what a recording is ordered by, and what is shown of it. */
const CELLS = {
  name: [({ listing }) => listing.name, (row) => <Name row={row} />],
  strip: [getLength, (row) => <Strip row={row} />],
  length: [getLength, (row) => (row.table ? formatTime(getLength(row)!, 0) : "")],
  rate: [
    ({ table }) => table && table.fps,
    ({ table }) => (table ? `${Number(table.fps.toFixed(2))} Hz` : ""),
  ],
  activities: [({ activities }) => activities, ({ activities }) => activities],
  primitives: [({ primitives }) => primitives, ({ primitives }) => primitives],
  checked: [
    ({ tally }) => tally && tally.checked / Math.max(tally.all, 1),
    ({ tally }) =>
      tally && (
        <>
          <progress max={tally.all} value={tally.checked} aria-hidden="true" />{" "}
          {Math.floor((100 * tally.checked) / Math.max(tally.all, 1))} %
        </>
      ),
  ],
  least: [({ least }) => least, (row) => <LowestConfidence row={row} />],
  notes: [({ comments }) => comments || null, ({ comments }) => comments || null],
  status: [({ status }) => STATUS_ORDER.indexOf(status), ({ status }) => status],
} satisfies Record<
  string,
  [getKey: (row: Row) => string | number | null, render: (row: Row) => ComponentChildren]
>;
type Column = keyof typeof CELLS;

/** Render a recording's row in the folder table. */
function FolderRow(props: { row: Row; at: number; top: number; columns: readonly Column[] }) {
  const { row, at, top, columns } = props;
  const { session } = useStudio();
  const current = session.store.recording.value?.id === row.listing.id;
  return (
    <div
      role="row"
      class={current ? "folder-row current" : "folder-row"}
      aria-rowindex={at + 2}
      style={{ top: `${top}px` }}
    >
      {columns.map((column) => (
        <span key={column} role={column === "name" ? "rowheader" : "cell"} class={`cell ${column}`}>
          {CELLS[column][1](row)}
        </span>
      ))}
    </div>
  );
}

function Name({ row: { listing } }: { row: Row }) {
  const { session, view } = useStudio();
  const opening = session.opening.value === listing.id;
  return (
    <Button
      class="plain name"
      aria-label={`Open ${listing.name}`}
      title={`Open ${listing.name}`}
      aria-busy={opening}
      onClick={() => void session.open(listing.id).then(() => (view.folder.value = null))}
      busy={opening}
    >
      <TruncatedName name={listing.name} />
    </Button>
  );
}

function Strip({ row: { table } }: { row: Row }) {
  const { review } = useStudio();
  if (table) return <span class="gradient" style={{ background: getStrip(table) }} />;
  return <span class="quiet">{review.folder.isReady.value ? "not segmented yet" : ""}</span>;
}

function LowestConfidence({ row: { listing, table } }: { row: Row }) {
  const { review, view } = useStudio();
  const { id, name } = listing;
  const places = table ? getDoubts(table).slice(0, MAX_PLACES) : [];
  return (
    <>
      {places
        .filter(({ confidence }) => confidence.value !== null)
        .map((doubt) => (
          <Button
            key={getSegmentKey(doubt.segment)}
            class="plain"
            title={`${getSegmentName(doubt.segment)}. ${doubt.confidence.why}`}
            onClick={() => {
              void review.queue
                .goTo({ id, recording: name, doubt })
                .then(() => (view.folder.value = null));
            }}
          >
            {doubt.confidence.short}{" "}
            <span class="quiet">at {formatTime(doubt.segment.start_s, 1)}</span>
          </Button>
        ))}
    </>
  );
}

/** Titles, widths and tooltips. */
export const COLUMNS: readonly {
  id: Column;
  title: string;
  /** Minimum width in pixels; `share` is its fraction of the remaining width. */
  least: number;
  share?: number;
  help: string;
}[] = [
  { id: "name", title: "Recording", least: 170, share: 1.4, help: "Its file" },
  {
    id: "strip",
    title: "Segments in time",
    least: 120,
    share: 3,
    help: "Its activities, in the colours of their clusters",
  },
  { id: "length", title: "Length", least: 64, help: "Minutes and seconds" },
  { id: "rate", title: "Rate", least: 64, help: "Frames per second" },
  { id: "activities", title: "Activities", least: 66, help: "How many it has" },
  { id: "primitives", title: "Primitives", least: 68, help: "Repetitions, and what else recurs" },
  {
    id: "checked",
    title: "Checked",
    least: 92,
    help: "How much of its table somebody checked, activities, primitives and transitions",
  },
  {
    id: "least",
    title: "Lowest confidence",
    least: 212,
    help: "The places of lowest confidence that nobody has checked",
  },
  { id: "notes", title: "Notes", least: 54, help: "Comments on its segments" },
  { id: "status", title: "Status", least: 78, help: "New, corrected, labelled or checked" },
];

const GAP = 10; // pixels between columns
const OPTIONAL_COLUMNS: readonly Column[] = [
  "rate",
  "length",
  "notes",
  "status",
  "primitives",
  "activities",
];

/** Return CSS grid columns and their minimum width in pixels. */
function getGrid(columns: readonly (typeof COLUMNS)[number][]): [string, number] {
  const widths = columns.map(({ least, share }) =>
    share ? `minmax(${least}px, ${share}fr)` : `${least}px`,
  );
  return [widths.join(" "), columns.reduce((sum, { least }) => sum + least + GAP, GAP)];
}

/** Return the columns that fit a width; the least important are dropped first. */
export function fitColumns(
  columns: readonly (typeof COLUMNS)[number][],
  width: number,
): readonly (typeof COLUMNS)[number][] {
  let kept = columns;
  for (const id of OPTIONAL_COLUMNS) {
    if (getGrid(kept)[1] <= width) break;
    kept = kept.filter((each) => each.id !== id);
  }
  return kept;
}

interface Row extends FolderMember {
  status: Status;
  tally: Tally | null;
  activities: number | null;
  primitives: number | null;
  least: number | null;
}

export function createRow(member: FolderMember, status: Status): Row {
  const { table } = member;
  return {
    ...member,
    status,
    tally: table && computeTally(table),
    activities: table && countSegments(table, "activity"),
    primitives: table && countSegments(table, "primitive"),
    least: table && getLowestConfidence(table),
  };
}

/** Sort rows by a column; unknown values come last. */
export function sortRows(rows: readonly Row[], by: Column, reverse: boolean): Row[] {
  const sign = reverse ? -1 : 1;
  const keys = new Map<Row, string | number | null>(rows.map((row) => [row, CELLS[by][0](row)]));
  return [...rows].sort((a, b) => {
    const [left, right] = [keys.get(a)!, keys.get(b)!];
    if (left === null || right === null) return Number(left === null) - Number(right === null);
    if (typeof left === "string") return sign * left.localeCompare(String(right), "en");
    return sign * (left - Number(right));
  });
}

/** Return a recording's duration in seconds; null without a table. */
function getLength({ table }: Row): number | null {
  return table && table.n_frames / table.fps;
}
