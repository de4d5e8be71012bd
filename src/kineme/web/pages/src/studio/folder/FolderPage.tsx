/** List all recordings of the folder; only visible rows are rendered. */
import { formatCount } from "../../formatCount";
import { computed, useSignal, useSignalEffect } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect, useLayoutEffect, useMemo, useRef } from "preact/hooks";
import { listen } from "../../layout/browser";
import { isPlayerKey } from "../../focus";
import { AddFiles } from "../panels/AddFiles";

import { useStudio } from "../context";
import { PosesOffer } from "../poses/PosesOffer";
import { STATUSES } from "../recordingList";
import { FolderProgress } from "./FolderProgress";
import { FolderRow } from "./FolderRow";
import { COLUMNS, fitColumns, getGrid, sortRows, createRow, type Column } from "./rows";
import { shownColumns, showColumn } from "./shownColumns";
import { Button, Checkbox, Select, TextInput } from "../../layout/controls";

const COVERED = ".layout > :not(.place-header)";
const [ROW_HEIGHT, LOW_ROW_HEIGHT] = [30, 26]; // pixels; the lower one is for low windows
const LOW_WINDOW = 480; // pixels, as in folder.css
const HEADER_BOTTOM = 40; // pixels, if the header has one line and no notices above
const OVERSCAN = 6; // rows rendered above and below the visible ones

export function FolderPage(): JSX.Element | null {
  const { session, view } = useStudio();
  const files = new Set(session.state.value?.recordings.map((each) => each.file));
  const several = files.size > 1;
  // The viewer asks a question.
  const asks = session.question.value !== "" || session.videoWithoutPoses.value;
  const none = !session.store.opened.value.length && !session.opening.value && !asks;
  if (!(view.folder.value ?? (several && none))) return null;
  return <Page />;
}

function Page(): JSX.Element {
  const { session, review, view } = useStudio();
  const { folder } = review;
  const { list } = session;
  const order = useSignal<[Column, boolean]>(["name", false]);
  const top = useSignal(0);
  const height = useSignal(600);
  const width = useSignal(Infinity);
  const head = useSignal(HEADER_BOTTOM);
  const place = useRef<HTMLDivElement>(null);
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
      height.value = place.current?.clientHeight ?? 600;
      width.value = place.current?.clientWidth ?? Infinity;
      head.value = bar?.getBoundingClientRect().bottom ?? HEADER_BOTTOM;
    });
    for (const each of [place.current, bar, document.querySelector(".notices")])
      if (each) sized.observe(each);
    return () => sized.disconnect();
  }, [folder, height, width, head]);
  useOverlay();
  const chosen = COLUMNS.filter(({ id }) => shownColumns.value.includes(id));
  const columns = fitColumns(chosen, width.value);
  const [widths, least] = getGrid(columns);
  const rowHeight = innerHeight > LOW_WINDOW ? ROW_HEIGHT : LOW_ROW_HEIGHT;
  const grid = {
    "--columns": widths,
    "--least": `${least}px`,
    "--row": `${rowHeight}px`,
    "--head": `${head.value}px`,
  };
  const from = Math.max(Math.floor(top.value / rowHeight) - OVERSCAN, 0);
  const to = Math.ceil((top.value + height.value) / rowHeight) + OVERSCAN;
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
        ref={place}
        class="folder-rows"
        role="table"
        aria-label="Recordings of the folder"
        aria-rowcount={rows.value.length + 1}
        tabIndex={0}
        onScroll={(event) => (top.value = event.currentTarget.scrollTop)}
      >
        <div role="row" class="folder-row folder-head" aria-rowindex={1}>
          {columns.map(({ id, title, help }) => {
            const [by, reverse] = order.value;
            const sorted = by === id ? (reverse ? "descending" : "ascending") : "none";
            return (
              <span key={id} role="columnheader" aria-sort={sorted}>
                <Button
                  class="plain"
                  title={`${help}; order by it`}
                  onClick={() => (order.value = [id, by === id && !reverse])}
                >
                  {title}
                  {by === id && (reverse ? " ▾" : " ▴")}
                </Button>
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
function SegmentAllButton(): JSX.Element | null {
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
