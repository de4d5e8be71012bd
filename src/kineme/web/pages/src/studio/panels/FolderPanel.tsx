/** List the recordings of the folder, to search, open and compare. */
import type { JSX } from "preact";

import { AddFiles } from "./AddFiles";
import { TruncatedName } from "./TruncatedName";
import { useStudio } from "../context";
import { countChecked } from "../../segments";
import type { Listing } from "../../messages";
import { ORDERS, STATUSES, type Status } from "../recordingList";
import { Button, CloseButton, Select, TextInput } from "../../layout/controls";

const SIGNS: Record<Status, string> = { new: "", corrected: "✎", labelled: "◐", checked: "✓" };

export function FolderPanel(): JSX.Element {
  const { session, view } = useStudio();
  const { search, status, order } = session.list;
  const all = session.state.value?.recordings ?? [];
  const found = session.list.listed.value;
  const done = all.filter((each) => session.list.getStatus(each) === "checked").length;
  return (
    <section class="folder-panel" aria-label="Recordings">
      <div class="panel-head">
        <h2>Recordings</h2>
        <span class="spacer" />
        {all.length > 1 && (
          <Button
            title="All recordings with their segments, and how far each is"
            onClick={() => (view.folder.value = true)}
          >
            Folder
          </Button>
        )}
        <AddFiles />
      </div>
      {all.length > 1 && (
        <div class="folder-filter">
          <TextInput
            type="search"
            placeholder="Search"
            aria-label="Search the recordings"
            value={search}
          />
          <Select
            label="Show recordings that are"
            value={status.value}
            options={STATUSES}
            onSelect={(chosen) => (status.value = chosen)}
          />
          <Select
            label="Order of the recordings"
            value={order.value}
            options={ORDERS}
            onSelect={(chosen) => (order.value = chosen)}
          />
        </div>
      )}
      {done > 0 && (
        <p class="quiet note">
          {done} of {all.length} checked
        </p>
      )}
      <ul class="recordings">
        {found.map((listing) => (
          <RecordingRow key={listing.id} listing={listing} />
        ))}
      </ul>
      <EmptyHint all={all.length} found={found.length} suffixes={session.state.value?.suffixes} />
    </section>
  );
}

function RecordingRow({ listing }: { listing: Listing }): JSX.Element {
  const { session, view } = useStudio();
  const { id, name } = listing;
  const { store } = session;
  const open = store.opened.value.find((each) => each.recording.value.id === id)?.recording.value;
  const shown = open !== undefined;
  const status = session.list.getStatus(listing);
  const checked = open ? countChecked(open.segmentation) : listing.checked;
  const segments = open?.segmentation.segments.length ?? listing.segments;
  const facts = [
    formatFileSize(listing.bytes),
    status,
    ...(status === "corrected" ? [`${checked} of ${segments} segments checked`] : []),
    ...(listing.named ? [`${listing.named} with a name`] : []),
  ];
  const current = store.recording.value?.id === id;
  const opening = session.opening.value === id;
  const several = store.opened.value.length > 1;
  return (
    <li class={current ? "current" : ""}>
      <Button
        class="recording"
        aria-current={current ? "true" : undefined}
        aria-busy={opening}
        title={`${name}: ${facts.join(", ")}`}
        onClick={() => {
          view.folder.value = null;
          void session.open(id, { beside: shown });
        }}
      >
        <TruncatedName name={name} />
        {opening ? <span class="busy" /> : <span aria-hidden="true">{SIGNS[status]}</span>}
      </Button>
      {shown && several ? (
        <CloseButton label={`Close ${name}`} title="Close" onClick={() => session.close(id)} />
      ) : (
        !shown &&
        store.opened.value.length > 0 && (
          <Button
            class="icon"
            aria-label={`Show ${name} beside the others`}
            title="Show beside the others"
            onClick={() => void session.open(id, { beside: true })}
          >
            +
          </Button>
        )
      )}
    </li>
  );
}

function EmptyHint(props: {
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

export function formatFileSize(bytes: number): string {
  return bytes < 1e6 ? `${Math.ceil(bytes / 1e3)} kB` : `${(bytes / 1e6).toFixed(1)} MB`;
}
