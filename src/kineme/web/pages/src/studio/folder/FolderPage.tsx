/**
 * All recordings of the folder, a row each. Only the rows that are seen are there, so that five
 * hundred scroll like ten.
 */
import { counted } from "../../counted";
import { computed, useSignal, useSignalEffect } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect, useLayoutEffect, useMemo, useRef } from "preact/hooks";
import { isForPlayer } from "../../focus";
import { AddFiles } from "../panels/AddFiles";

import { useStudio } from "../context";
import { PosesOffer } from "../poses/PosesOffer";
import { STATUSES } from "../recordingList";
import { FolderProgress } from "./FolderProgress";
import { FolderRow } from "./FolderRow";
import { COLUMNS, fitting, gridOf, ordered, rowOf, type Column } from "./rows";
import { shownColumns, showColumn } from "./shownColumns";
import { Button, Checkbox, Select } from "../../layout/controls";

const BELOW = ".layout > :not(.place-header)";
const [HEIGHT, LOW] = [30, 26]; // pixels of a row: as usual, in a low window
const LOW_WINDOW = 480; // pixels, as in folder.css
const HEAD = 40; // where the bar on top ends, if it is one line and nothing lies above
const MORE = 6; // rows drawn above and below what is seen

export function FolderPage(): JSX.Element | null {
  const { session, front } = useStudio();
  const files = new Set(session.state.value?.recordings.map((each) => each.file));
  const several = files.size > 1;
  const asks = session.question.value !== "" || session.needing.value; // on the stage
  const none = !session.store.opened.value.length && !session.opening.value && !asks;
  if (!(front.folder.value ?? (several && none))) return null;
  return <Page />;
}

function Page(): JSX.Element {
  const { session, review, front } = useStudio();
  const { folder } = review;
  const { list } = session;
  const order = useSignal<[Column, boolean]>(["name", false]);
  const top = useSignal(0);
  const height = useSignal(600);
  const width = useSignal(Infinity);
  const head = useSignal(HEAD);
  const place = useRef<HTMLDivElement>(null);
  const rows = useMemo(
    () =>
      computed(() => {
        const text = list.search.value.trim().toLowerCase();
        const all = folder.members.value.map((each) => rowOf(each, list.statusOf(each.listing)));
        const found = all.filter(
          ({ listing, status }) =>
            listing.name.toLowerCase().includes(text) &&
            (!list.status.value || status === list.status.value),
        );
        return ordered(found, ...order.value);
      }),
    [folder, list, order],
  );
  useEffect(() => {
    void folder.refresh();
    const bar = document.querySelector(".place-header");
    scrollTo(0, 0); // on a small screen, where the bar is a part of what scrolls
    const sized = new ResizeObserver(() => {
      height.value = place.current?.clientHeight ?? 600;
      width.value = place.current?.clientWidth ?? Infinity;
      head.value = bar?.getBoundingClientRect().bottom ?? HEAD;
    });
    for (const each of [place.current, bar, document.querySelector(".notices")])
      if (each) sized.observe(each);
    return () => sized.disconnect();
  }, [folder, height, width, head]);
  useOver();
  const chosen = COLUMNS.filter(({ id }) => shownColumns.value.includes(id));
  const columns = fitting(chosen, width.value);
  const [widths, least] = gridOf(columns);
  const rowHeight = innerHeight > LOW_WINDOW ? HEIGHT : LOW;
  const grid = {
    "--columns": widths,
    "--least": `${least}px`,
    "--row": `${rowHeight}px`,
    "--head": `${head.value}px`,
  };
  const from = Math.max(Math.floor(top.value / rowHeight) - MORE, 0);
  const to = Math.ceil((top.value + height.value) / rowHeight) + MORE;
  const isOpen = session.store.opened.value.length > 0;
  return (
    <section class="folder-page" aria-label="Folder" style={grid}>
      <div class="folder-tools">
        <h2>{session.state.value?.folder.split(/[\\/]/).at(-1)}</h2>
        <FolderProgress tally={folder.tally.value} />
        <span class="spacer" />
        <AddFiles />
        <Find />
        <Button
          class="primary"
          title="Through all recordings, what has the lowest confidence first (J)"
          onClick={() => void review.goEverywhere(true)}
        >
          Review all recordings
        </Button>
        {isOpen && (
          <Button onClick={() => (front.folder.value = null)}>Back to the recording</Button>
        )}
      </div>
      <PosesOffer all />
      <div class="folder-tools">
        <input
          type="search"
          placeholder="Filter by name"
          aria-label="Filter the recordings by name"
          value={list.search.value}
          onInput={(event) => (list.search.value = event.currentTarget.value)}
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

/** What lies below takes no keys: nothing is edited that is not seen. It goes where one goes. */
function useOver(): void {
  const { session, review, front } = useStudio();
  const { store } = session;
  const first = useRef(true);
  useSignalEffect(() => {
    void [store.recording.value?.id, review.queue.looking.value];
    if (!first.current) front.folder.value = null;
    first.current = false;
  });
  useLayoutEffect(() => {
    const below = [...document.querySelectorAll<HTMLElement>(BELOW)];
    for (const each of below) each.inert = true;
    const onKey = (event: KeyboardEvent): void => {
      if (!store.recording.peek() || document.querySelector("dialog[open]")) return;
      event.stopPropagation();
      if (event.key === "Escape") front.folder.value = null;
      if (event.key === "j" && isForPlayer(event)) void review.goEverywhere(true);
    };
    addEventListener("keydown", onKey, { capture: true });
    return () => {
      for (const each of below) each.inert = false;
      removeEventListener("keydown", onKey, { capture: true });
    };
  }, [store, review, front]);
}

/** Segments for the recordings that have none, and how far that is. */
function Find(): JSX.Element | null {
  const { review } = useStudio();
  const { folder } = review;
  const { value: finding } = folder.finding;
  const { length: n } = folder.without.value;
  if (finding)
    return (
      <span class="quiet number" role="status">
        <span class="busy" /> segmenting {finding.done + 1} of {finding.all}…
      </span>
    );
  if (!n || !folder.ready.value) return null;
  return (
    <Button
      title="Find the segments of the recordings that have none yet; they are saved once you edit them"
      onClick={() => void folder.find()}
    >
      Segment {counted(n, "recording")}
    </Button>
  );
}
