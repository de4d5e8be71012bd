/** The recordings of the folder: search, open, show beside, add. */
import type { JSX } from "preact";
import { StatusOptions } from "../folder/StatusOptions";
import { AddFiles } from "./AddFiles";
import { MiddleShortened } from "./MiddleShortened";
import { useStudio } from "../context";
import { checkedIn } from "../../segments";
import type { Listing } from "../../messages";
import type { Order, Status } from "../recordingList";

const SIGNS: Record<Status, string> = { new: "", corrected: "✎", labelled: "◐", checked: "✓" };

export function FolderPanel(): JSX.Element {
  const { session, front } = useStudio();
  const { search, status } = session.list;
  const all = session.state.value?.recordings ?? [];
  const found = session.list.listed.value;
  const done = all.filter((each) => session.list.statusOf(each) === "checked").length;
  return (
    <section class="folder-panel" aria-label="Recordings">
      <div class="panel-head">
        <h2>Recordings</h2>
        <span class="spacer" />
        {all.length > 1 && (
          <button
            type="button"
            title="All recordings with their segments, and how far each is"
            onClick={() => (front.folder.value = true)}
          >
            Folder
          </button>
        )}
        <AddFiles />
      </div>
      {all.length > 1 && (
        <div class="folder-filter">
          <input
            type="search"
            placeholder="Search"
            aria-label="Search the recordings"
            value={search.value}
            onInput={(event) => (search.value = event.currentTarget.value)}
          />
          <select
            aria-label="Show recordings that are"
            value={status.value}
            onChange={(event) => (status.value = event.currentTarget.value as Status | "")}
          >
            <StatusOptions />
          </select>
          <select
            aria-label="Order of the recordings"
            value={session.list.order.value}
            onChange={(event) => (session.list.order.value = event.currentTarget.value as Order)}
          >
            <option value="name">by name</option>
            <option value="left">what is left first</option>
            <option value="size">largest first</option>
          </select>
        </div>
      )}
      {done > 0 && (
        <p class="quiet note">
          {done} of {all.length} checked
        </p>
      )}
      <ul class="recordings">
        {found.map((listing) => (
          <Row key={listing.id} listing={listing} />
        ))}
      </ul>
      <Hint all={all.length} found={found.length} suffixes={session.state.value?.suffixes} />
    </section>
  );
}

function Row({ listing }: { listing: Listing }): JSX.Element {
  const { session, front } = useStudio();
  const { id, name } = listing;
  const { store } = session;
  const open = store.opened.value.find((each) => each.recording.value.id === id)?.recording.value;
  const shown = open !== undefined;
  const status = session.list.statusOf(listing);
  const checked = open ? checkedIn(open.segmentation) : listing.checked;
  const segments = open?.segmentation.segments.length ?? listing.segments;
  const facts = [
    megabytes(listing.bytes),
    status,
    ...(status === "corrected" ? [`${checked} of ${segments} segments checked`] : []),
    ...(listing.named ? [`${listing.named} with a name`] : []),
  ];
  const current = store.recording.value?.id === id;
  const opening = session.opening.value === id;
  const several = store.opened.value.length > 1;
  return (
    <li class={current ? "current" : ""}>
      <button
        type="button"
        class="recording"
        aria-current={current ? "true" : undefined}
        aria-busy={opening}
        title={`${name}: ${facts.join(", ")}`}
        onClick={() => {
          front.folder.value = null;
          void session.open(id, { beside: shown });
        }}
      >
        <MiddleShortened name={name} />
        {opening ? <span class="busy" /> : <span aria-hidden="true">{SIGNS[status]}</span>}
      </button>
      {shown && several ? (
        <button
          type="button"
          class="icon"
          aria-label={`Close ${name}`}
          title="Close"
          onClick={() => session.close(id)}
        >
          ×
        </button>
      ) : (
        !shown &&
        store.opened.value.length > 0 && (
          <button
            type="button"
            class="icon"
            aria-label={`Show ${name} beside the others`}
            title="Show beside the others"
            onClick={() => void session.open(id, { beside: true })}
          >
            +
          </button>
        )
      )}
    </li>
  );
}

function Hint(props: {
  all: number;
  found: number;
  suffixes: string[] | undefined;
}): JSX.Element | null {
  const { all, found, suffixes } = props;
  if (!suffixes) return <p class="hint quiet">The list of recordings is loading.</p>;
  if (all === 0)
    return (
      <p class="hint quiet">
        No recordings here yet. Drop files on this page ({suffixes.join(", ")}), or choose them with
        “Add…”.
      </p>
    );
  if (found === 0) return <p class="hint quiet">No name holds that text.</p>;
  return null;
}

export function megabytes(bytes: number): string {
  return bytes < 1e6 ? `${Math.ceil(bytes / 1e3)} kB` : `${(bytes / 1e6).toFixed(1)} MB`;
}
