/** The recordings of the folder: search, open, show beside, add. */
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import type { Listing } from "../../messages";
import type { Session } from "../session";
import type { Uploads } from "../server/uploads";

interface Props {
  session: Session;
  uploads: Uploads;
}

export function FolderPanel({ session, uploads }: Props): JSX.Element {
  const search = useSignal("");
  const all = session.state.value?.recordings ?? [];
  const wanted = search.value.trim().toLowerCase();
  const found = all.filter((each) => each.name.toLowerCase().includes(wanted));
  return (
    <section class="folder-panel" aria-label="Recordings">
      <div class="panel-head">
        <h2>Recordings</h2>
        <span class="spacer" />
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
      </div>
      {all.length > 1 && (
        <input
          type="search"
          placeholder="Search"
          aria-label="Search the recordings"
          value={search.value}
          onInput={(event) => (search.value = event.currentTarget.value)}
        />
      )}
      <ul class="recordings">
        {found.map((listing) => (
          <Row key={listing.id} session={session} listing={listing} />
        ))}
      </ul>
      {uploads.running.value.map(({ name, share }) => (
        <p class="upload" key={name}>
          <span>{name}</span>
          <progress value={share} aria-label={`Sending ${name}`} />
        </p>
      ))}
      <Hint all={all.length} found={found.length} suffixes={session.state.value?.suffixes ?? []} />
    </section>
  );
}

function Row({ session, listing }: { session: Session; listing: Listing }): JSX.Element {
  const { id, name } = listing;
  const { store } = session;
  const open = store.opened.value.find((each) => each.recording.value.id === id)?.recording.value;
  const shown = open !== undefined;
  const corrected = listing.corrected || Boolean(open?.saved);
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
        title={`${name}, ${megabytes(listing.bytes)}${corrected ? ", corrected" : ""}`}
        onClick={() => void session.open(id, { beside: shown })}
      >
        <span class="name">{name}</span>
        {opening ? <span class="busy" /> : corrected && <span title="corrected">✎</span>}
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

function Hint(props: { all: number; found: number; suffixes: string[] }): JSX.Element | null {
  const { all, found, suffixes } = props;
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

function megabytes(bytes: number): string {
  return bytes < 1e6 ? `${Math.ceil(bytes / 1e3)} kB` : `${(bytes / 1e6).toFixed(1)} MB`;
}
