/** List the recordings of the folder, to search, open and compare. */
import { useStudio } from "../context";
import { countChecked } from "../../segments";
import type { Listing } from "../../messages";
import { ORDERS, STATUSES, type Status } from "./recordingList";
import { Button, CloseButton, Select, TextInput } from "../../layout/controls";
import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { listen } from "../../util";

const SIGNS: Record<Status, string> = { new: "", corrected: "✎", labelled: "◐", checked: "✓" };

export function FolderPanel() {
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

function RecordingRow({ listing }: { listing: Listing }) {
  const { session, view } = useStudio();
  const { id, name } = listing;
  const { store } = session;
  const open = store.opened.value[store.findIndex(id)]?.recording.value;
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

function EmptyHint(props: { all: number; found: number; suffixes: string[] | undefined }) {
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

function formatFileSize(bytes: number): string {
  return bytes < 1e6 ? `${Math.ceil(bytes / 1e3)} kB` : `${(bytes / 1e6).toFixed(1)} MB`;
}

/** Choose files to upload and show their progress. */
export function AddFiles() {
  const { uploads } = useStudio();
  return (
    <>
      <label
        class="button"
        title="Add files to the folder; dropping them on the page does the same"
      >
        Add…
        <input
          class="unseen"
          type="file"
          multiple
          onChange={(event) => {
            const input = event.currentTarget;
            void uploads.add([...(input.files ?? [])]);
            input.value = "";
          }}
        />
      </label>
      {uploads.running.value.map(({ name, share }) => (
        <span class="upload" key={name}>
          <span>{name}</span>
          <progress value={share.value} aria-label={`Sending ${name}`} />
        </span>
      ))}
    </>
  );
}

const TAIL = 12; // letters at the end that always stay visible

/** Show a name whose middle is shortened first, since recordings often differ at the end. */
export function TruncatedName({ name }: { name: string }) {
  const cut = Math.max(name.length - TAIL, 0);
  return (
    <span class="name halves">
      <span>{name.slice(0, cut)}</span>
      <span>{name.slice(cut)}</span>
    </span>
  );
}

/** Show which recording is loading, with a button to cancel. */
export function OpeningProgress() {
  const { session } = useStudio();
  const id = session.opening.value;
  const listing = session.state.value?.recordings.find((each) => each.id === id);
  const seconds = useSignal(0);
  useEffect(() => {
    seconds.value = 0;
    const timer = window.setInterval(() => (seconds.value += 1), 1000);
    return () => window.clearInterval(timer);
  }, [id, seconds]);
  if (!listing || seconds.value === 0) return null; // most recordings open within a second
  return (
    <p class="opening">
      Reading {listing.name}, {formatFileSize(listing.bytes)}: {seconds.value} s{" "}
      <Button onClick={() => session.stopOpening()}>Cancel</Button>
    </p>
  );
}

/** Upload files dropped anywhere on the page. */
export function DropZone() {
  const { session, uploads } = useStudio();
  const over = useSignal(false);
  useEffect(() => {
    const holdsFiles = (event: DragEvent): boolean =>
      event.dataTransfer?.types.includes("Files") ?? false;
    const onOver = (event: DragEvent): void => {
      if (!holdsFiles(event)) return;
      event.preventDefault();
      over.value = true;
    };
    const onLeave = (event: DragEvent): void => {
      if (event.relatedTarget === null) over.value = false;
    };
    const onDrop = (event: DragEvent): void => {
      if (!holdsFiles(event)) return;
      event.preventDefault();
      over.value = false;
      void uploads.add([...(event.dataTransfer?.files ?? [])]);
    };
    return listen(window, { dragover: onOver, dragleave: onLeave, drop: onDrop });
  }, [uploads, over]);
  if (!over.value) return null;
  return (
    <div class="drop-zone" aria-hidden="true">
      <p>Drop to add to {session.state.value?.folder}</p>
    </div>
  );
}
