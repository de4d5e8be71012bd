/** Combine tables of all recordings of the folder: those of this page, else the server's. */
import { batch, computed, effect, signal, untracked, type Signal } from "@preact/signals";
import type { Listing, Segments } from "../../messages";
import { countChecked } from "../../segments";
import { delay, formatCount } from "../../util";
import { Unreachable, describeUnchanged, explainError, type Refused } from "../server/api";
import type { Session } from "../session";
import { computeTally, unpackTable, type Tally } from "./briefTables";

const POLL_INTERVAL = 500; // milliseconds

/** A recording of the folder with its table, if any. */
export interface FolderMember {
  listing: Listing;
  table: Segments | null;
  comments: number;
}

export class Folder {
  /** Whether the tables are loaded. */
  readonly isReady = signal(false);
  /** Progress of `segmentAll`; null if it is not running. */
  readonly segmenting = signal<{ done: number; all: number } | null>(null);
  readonly members = computed<FolderMember[]>(() =>
    (this.session.state.value?.recordings ?? []).map((listing) => {
      const served = this.serverTables.value.get(listing.id);
      const shown = this.pageTables.value.get(listing.id);
      const comments = shown?.segments.filter((row) => row.comment).length ?? served?.comments ?? 0;
      return { listing, table: shown ?? served?.table ?? null, comments };
    }),
  );
  readonly tally = computed<Tally>(() => {
    const sum = { all: 0, checked: 0, doubtful: 0 };
    for (const { table } of this.members.value) {
      if (!table) continue;
      const { all, checked, doubtful } = computeTally(table);
      sum.all += all;
      sum.checked += checked;
      sum.doubtful += doubtful;
    }
    return sum;
  });
  /** Recordings that can be segmented and are not. */
  readonly unsegmented = computed(() =>
    this.members.value.filter(({ table, listing }) => !table && !listing.needs_poses),
  );

  private readonly serverTables = signal<
    ReadonlyMap<string, { table: Segments; comments: number }>
  >(new Map());
  /** Tables of recordings that are or were open here since the last load. */
  private readonly pageTables = signal<ReadonlyMap<string, Segments>>(new Map());
  private pendingRequest: Promise<void> | null = null;
  /** Whether the last request got no answer. */
  private isUnanswered = false;

  constructor(readonly session: Session) {
    effect(() => {
      const open = session.recordings.value
        .filter((edited) => !edited.confirmed.value.finding)
        .map((edited) => [edited.id, edited.confirmed.value.segmentation] as const);
      const pageTables = untracked(() => this.pageTables.value);
      if (open.some(([id, table]) => pageTables.get(id) !== table))
        this.pageTables.value = new Map([...pageTables, ...open]);
    });
    effect(() => {
      const { value: state } = session.state;
      const behind = untracked(() => (this.isReady.value ? this.isOutdated() : this.isUnanswered));
      if (state && behind) untracked(() => void this.refresh());
    });
  }

  /** Load all tables; concurrent calls share one request. */
  refresh(): Promise<void> {
    this.pendingRequest ??= this.loadTables().finally(() => (this.pendingRequest = null));
    return this.pendingRequest;
  }

  /** Segment all recordings without segments, one after the other. */
  async segmentAll(): Promise<void> {
    if (this.segmenting.value) return;
    const { api, notifications } = this.session;
    const left = this.unsegmented.value.map(({ listing }) => listing);
    const failed: string[] = [];
    for (const [done, { id, name }] of left.entries()) {
      this.segmenting.value = { done, all: left.length };
      try {
        while ((await api.loadRecording(id)).finding) await delay(POLL_INTERVAL);
      } catch (error) {
        failed.push(`${name}: ${explainError(error)}`);
      }
      if (done % 5 === 4) await this.refresh();
    }
    await this.refresh();
    this.segmenting.value = null;
    notifications.clearProblem("find");
    const more = failed.length > 1 ? ` (and ${failed.length - 1} more)` : "";
    if (failed.length) notifications.reportProblem(`Not segmented: ${failed[0]}${more}`, "find");
  }

  /** Return whether the folder listing refers to newer tables. */
  private isOutdated(): boolean {
    return this.members.value.some(({ listing, table }) => {
      if (!table || !listing.corrected) return listing.corrected;
      const named = table.segments.filter(({ label }) => label).length;
      const counts = [table.segments.length, countChecked(table), named];
      return counts.join() !== [listing.segments, listing.checked, listing.named].join();
    });
  }

  private async loadTables(): Promise<void> {
    const { session } = this;
    try {
      const { recordings } = await session.api.loadTables();
      const serverTables = recordings.flatMap(({ id, table }) =>
        table ? [[id, { table: unpackTable(table), comments: table.comments }] as const] : [],
      );
      const open = new Set(session.recordings.value.map(({ id }) => id));
      batch(() => {
        this.pageTables.value = new Map([...this.pageTables.value].filter(([id]) => open.has(id)));
        this.serverTables.value = new Map(serverTables);
        this.isReady.value = true;
      });
      this.isUnanswered = false;
      session.notifications.clearProblem("tables");
    } catch (error) {
      this.isUnanswered = error instanceof Unreachable || (error as Refused).status === 403;
      // Else the session reports it.
      if (!this.isUnanswered) session.notifications.reportProblem(explainError(error), "tables");
    }
  }
}

interface Offer {
  recording: string;
  cluster: number;
  before: string;
  label: string;
}

type Names = Readonly<Record<string, string>>;

export class NameOffer {
  /** null if there is nothing to offer. */
  readonly present = signal<Offer | null>(null);
  private lastNames: { id: string; names: Names } | null = null;

  constructor(private readonly folder: Folder) {
    const { session } = folder;
    effect(() => {
      const { id, segmentation, finding } = session.edited.value?.confirmed.value ?? {};
      if (!id || !segmentation || finding) return;
      const names = segmentation.cluster_names;
      const last = this.lastNames?.id === id ? this.lastNames.names : names;
      this.lastNames = { id, names };
      const other = findRenamed(last, names);
      untracked(() => {
        if (this.present.value?.recording !== id) this.present.value = null;
        if (other)
          this.present.value = this.isUseful(id, other) ? { recording: id, ...other } : null;
      });
    });
  }

  /** Apply the name to all recordings; each can undo it. */
  async accept(): Promise<void> {
    const { session } = this.folder;
    const { api, notifications } = session;
    const offer = this.present.value;
    if (!offer) return;
    this.present.value = null;
    await notifications.attempt("offer", async () => {
      const changed = await api.renameEverywhere(offer, this.isLibrary());
      const tables = formatCount(changed.tables, "saved table");
      notifications.tell(`“${offer.label}” in ${tables} more.${describeUnchanged(changed)}`);
      if (session.state.value) await session.refresh();
    });
  }

  isLibrary(): boolean {
    return this.folder.session.state.value?.of_library ?? false;
  }

  /** Return whether other recordings may have the named cluster. */
  private isUseful(id: string, { before, label }: { before: string; label: string }): boolean {
    const others = this.folder.members.value.filter(({ listing }) => listing.id !== id);
    if (!others.length || !label) return false;
    if (this.isLibrary() || (before && !this.folder.isReady.value)) return true;
    const has = (table: Segments): boolean => table.segments.some((row) => row.label === before);
    return before !== "" && others.some(({ table }) => table && has(table));
  }
}

/** Return the one cluster whose name changed; null if none or several did. */
function findRenamed(last: Names, names: Names): Omit<Offer, "recording"> | null {
  const all = new Set([...Object.keys(last), ...Object.keys(names)]);
  const changed = [...all].filter((cluster) => (last[cluster] ?? "") !== (names[cluster] ?? ""));
  const [cluster] = changed;
  if (cluster === undefined || changed.length > 1) return null;
  return { cluster: Number(cluster), before: last[cluster] ?? "", label: names[cluster] ?? "" };
}

interface Upload {
  name: string;
  /** Sent share, 0 to 1. */
  share: Signal<number>;
}

export class Uploads {
  readonly running = signal<Upload[]>([]);

  constructor(private readonly session: Session) {}

  /** Send files one after the other and open the first recording. */
  async add(files: readonly File[]): Promise<void> {
    const { session } = this;
    const ids: string[] = [];
    const uploads = files.map((file) => ({ file, name: file.name, share: signal(0) }));
    this.running.value = [...this.running.value, ...uploads];
    for (const upload of uploads) {
      const { file, name, share } = upload;
      const about = `upload ${name}`;
      try {
        ids.push((await session.api.upload(file, (sent) => (share.value = sent))).id);
        session.notifications.clearProblem(about);
      } catch (error) {
        session.notifications.reportProblem(`${name}: ${explainError(error)}`, about);
      }
      this.running.value = this.running.value.filter((each) => each !== upload);
    }
    await session.refresh();
    const listed = new Set(session.state.value?.recordings.map((each) => each.id));
    const first = ids.find((id) => listed.has(id));
    if (first) await session.open(first);
  }
}
