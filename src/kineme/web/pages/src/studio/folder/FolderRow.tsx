/** A recording of the folder: its strip, numbers, and the places of least confidence, to open. */
import type { JSX } from "preact";
import { useStudio } from "../context";
import { nameOf } from "../../segments";
import { clock } from "../../view";
import { MiddleShortened } from "../panels/MiddleShortened";
import { queueOf, stripOf } from "./briefTables";
import { secondsOf, type Column, type Row } from "./rows";
import { Button } from "../../layout/controls";

const PLACES = 2; // of the least sure ones
const CELLS: Record<Column, (row: Row) => JSX.Element | string> = {
  name: (row) => <Name row={row} />,
  strip: (row) => <Strip row={row} />,
  length: ({ table }) => (table ? clock(secondsOf(table), 0) : ""),
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
  least: (row) => <Least row={row} />,
  notes: ({ comments }) => (comments ? String(comments) : ""),
  status: ({ status }) => status,
};

interface Props {
  row: Row;
  at: number;
  top: number;
  columns: readonly Column[];
}

export function FolderRow({ row, at, top, columns }: Props): JSX.Element {
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

function Name({ row: { listing } }: { row: Row }): JSX.Element {
  const { session, front } = useStudio();
  const opening = session.opening.value === listing.id;
  return (
    <Button
      class="plain name"
      aria-label={`Open ${listing.name}`}
      title={`Open ${listing.name}`}
      aria-busy={opening}
      onClick={() => void session.open(listing.id).then(() => (front.folder.value = null))}
      busy={opening}
    >
      <MiddleShortened name={listing.name} />
    </Button>
  );
}

function Strip({ row: { table } }: { row: Row }): JSX.Element {
  const { review } = useStudio();
  if (table) return <span class="gradient" style={{ background: stripOf(table) }} />;
  return <span class="quiet">{review.folder.ready.value ? "not segmented yet" : ""}</span>;
}

function Least({ row: { listing, table } }: { row: Row }): JSX.Element {
  const { review, front } = useStudio();
  const { id, name } = listing;
  const places = table ? queueOf(table).slice(0, PLACES) : [];
  return (
    <>
      {places
        .filter(({ value }) => value !== null)
        .map((doubt) => (
          <Button
            key={`${doubt.segment.level} ${doubt.segment.start_frame}`}
            class="plain"
            title={`${nameOf(doubt.segment)}. ${doubt.why}`}
            onClick={() => {
              void review.queue
                .go({ id, recording: name, doubt })
                .then(() => (front.folder.value = null));
            }}
          >
            {doubt.short} <span class="quiet">at {clock(doubt.segment.start_s, 1)}</span>
          </Button>
        ))}
    </>
  );
}
