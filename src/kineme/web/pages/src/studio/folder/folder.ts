/** Combine tables of all recordings of the folder: those of this page, else the server's. */
import { batch, computed, effect, signal, untracked } from "@preact/signals";
import type { Listing, Segments } from "../../messages";
import { countChecked } from "../../segments";
import { delay } from "../delay";
import { explainError, type Refused, Unreachable } from "../server/api";
import type { Session } from "../session";
import { unpackTable, computeTally, type Tally } from "./briefTables";

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
