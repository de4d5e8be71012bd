/** Render a recording's row in the folder table. */
import type { JSX } from "preact";
import { useStudio } from "../context";
import { getSegmentKey, getSegmentName } from "../../segments";
import { formatTime } from "../../view";
import { TruncatedName } from "../panels/TruncatedName";
import { getDoubts, getStrip } from "./briefTables";
import { getLength, type Column, type Row } from "./rows";
import { Button } from "../../layout/controls";

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

function Strip({ row: { table } }: { row: Row }): JSX.Element {
  const { review } = useStudio();
  if (table) return <span class="gradient" style={{ background: getStrip(table) }} />;
  return <span class="quiet">{review.folder.isReady.value ? "not segmented yet" : ""}</span>;
}

function LowestConfidence({ row: { listing, table } }: { row: Row }): JSX.Element {
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
