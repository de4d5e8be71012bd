/** List all recordings of the folder; only visible rows are rendered. */
import { formatCount, listen } from "../../util";
import { computed, useSignal, useSignalEffect } from "@preact/signals";
import { useEffect, useLayoutEffect, useMemo, useRef } from "preact/hooks";
import { isPlayerKey } from "../../keys";
import { AddFiles, TruncatedName } from "../panels/FolderPanel";
import { useStudio } from "../context";
import { PosesOffer } from "../poses/PosesOffer";
import { type ColumnOrder, OrderButton, useVisibleRows } from "../longTable";
import { STATUSES } from "../recordingList";
import { FolderProgress } from "../review/ReviewPanel";
import {
  COLUMNS,
  fitColumns,
  getGrid,
  sortRows,
  createRow,
  type Column,
  shownColumns,
  showColumn,
  getLength,
  type Row,
} from "./rows";
import { Button, Checkbox, Select, TextInput } from "../../layout/controls";
import type { JSX } from "preact";
import { getSegmentKey, getSegmentName } from "../../segments";
import { formatTime } from "../../view";
import { getDoubts, getStrip } from "./briefTables";

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
  const chosen = COLUMNS.filter(({ id }) => shownColumns.value.includes(id));
  const columns = fitColumns(chosen, width.value);
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
        <details class="column-choice">
          <summary>
            Columns
            {columns.length < chosen.length && (
              <span class="quiet">
                {" "}
                ({columns.length} of {chosen.length} fit)
              </span>
            )}
          </summary>
          <fieldset>
            {COLUMNS.slice(1).map(({ id, title, help }) => (
              <Checkbox
                key={id}
                title={help}
                checked={shownColumns.value.includes(id)}
                onCheck={(checked) => showColumn(id, checked)}
              >
                {title}
              </Checkbox>
            ))}
          </fieldset>
        </details>
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
const CELLS: Record<Column, (row: Row) => JSX.Element | string> = {
  name: (row) => <Name row={row} />,
  strip: (row) => <Strip row={row} />,
  length: ({ table }) => (table ? formatTime(getLength(table), 0) : ""),
  rate: ({ table }) => (table ? `${Number(table.fps.toFixed(2))} Hz` : ""),
  activities: ({ activities }) => String(activities ?? ""),
  primitives: ({ primitives }) => String(primitives ?? ""),
  checked: ({ tally }) =>
    tally ? (
      <>
        <progress max={tally.all} value={tally.checked} aria-hidden="true" />{" "}
        {Math.floor((100 * tally.checked) / Math.max(tally.all, 1))} %
      </>
    ) : (
      ""
    ),
  least: (row) => <LowestConfidence row={row} />,
  notes: ({ comments }) => (comments ? String(comments) : ""),
  status: ({ status }) => status,
};

interface FolderRowProps {
  row: Row;
  at: number;
  top: number;
  columns: readonly Column[];
}

/** Render a recording's row in the folder table. */
function FolderRow({ row, at, top, columns }: FolderRowProps) {
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
          {CELLS[column](row)}
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
