/**
 * The tables of all recordings of the folder: those open here as they are shown, the others as the
 * server told last.
 */
import { batch, computed, effect, signal, untracked } from "@preact/signals";
import type { Listing, Segments } from "../../messages";
import { checkedIn } from "../../segments";
import { later } from "../later";
import { explain, type Refused, Unreachable } from "../server/api";
import type { Session } from "../session";
import { tableOf, tallyOf, type Tally } from "./briefTables";

const POLL = 500; // milliseconds between two looks for segments

/** A recording of the folder with its table, if it has one. */
export interface Member {
  listing: Listing;
  table: Segments | null;
  comments: number;
}

export class Folder {
  /** Whether the tables have been read. */
  readonly ready = signal(false);
  /** How many recordings have been segmented of those that were to be; null while none is. */
  readonly finding = signal<{ done: number; all: number } | null>(null);
  readonly members = computed<Member[]>(() =>
    (this.session.state.value?.recordings ?? []).map((listing) => {
      const ofServer = this.ofServer.value.get(listing.id);
      const ofPage = this.ofPage.value.get(listing.id);
      const comments =
        ofPage?.segments.filter((row) => row.comment).length ?? ofServer?.comments ?? 0;
      return { listing, table: ofPage ?? ofServer?.table ?? null, comments };
    }),
  );
  readonly tally = computed<Tally>(() => {
    const sum = { all: 0, checked: 0, doubtful: 0 };
    for (const { table } of this.members.value) {
      if (!table) continue;
      const { all, checked, doubtful } = tallyOf(table);
      sum.all += all;
      sum.checked += checked;
      sum.doubtful += doubtful;
    }
    return sum;
  });
  /** Those that can be segmented, and are not. */
  readonly without = computed(() =>
    this.members.value.filter(({ table, listing }) => !table && !listing.needs_poses),
  );

  private readonly ofServer = signal<ReadonlyMap<string, { table: Segments; comments: number }>>(
    new Map(),
  );
  /** Tables of recordings that are open here, or were since the server told of the others. */
  private readonly ofPage = signal<ReadonlyMap<string, Segments>>(new Map());
  private asked: Promise<void> | null = null;
  /** Whether nobody answered the last time. */
  private missed = false;

  constructor(readonly session: Session) {
    effect(() => {
      const open = session.recordings.value
        .filter((edited) => !edited.confirmed.value.finding)
        .map((edited) => [edited.id, edited.confirmed.value.segmentation] as const);
      const ofPage = untracked(() => this.ofPage.value);
      if (open.some(([id, table]) => ofPage.get(id) !== table))
        this.ofPage.value = new Map([...ofPage, ...open]);
    });
    effect(() => {
      const { value: state } = session.state;
      const behind = untracked(() => (this.ready.value ? this.isBehind() : this.missed));
      if (state && behind) untracked(() => void this.refresh());
    });
  }

  /** The tables as they are now; asked for once at a time. */
  refresh(): Promise<void> {
    this.asked ??= this.ask().finally(() => (this.asked = null));
    return this.asked;
  }

  /** Finds the segments of the recordings that have none, one after the other. */
  async find(): Promise<void> {
    if (this.finding.value) return;
    const { api, bulletin } = this.session;
    const left = this.without.value.map(({ listing }) => listing);
    const failed: string[] = [];
    for (const [done, { id, name }] of left.entries()) {
      this.finding.value = { done, all: left.length };
      try {
        while ((await api.recording(id)).finding) await later(POLL);
      } catch (error) {
        failed.push(`${name}: ${explain(error)}`);
      }
      if (done % 5 === 4) await this.refresh();
    }
    await this.refresh();
    this.finding.value = null;
    bulletin.solved("find");
    const more = failed.length > 1 ? ` (and ${failed.length - 1} more)` : "";
    if (failed.length) bulletin.problem(`Not segmented: ${failed[0]}${more}`, "find");
  }

  /** Whether the list of the folder tells of other tables than these. */
  private isBehind(): boolean {
    return this.members.value.some(({ listing, table }) => {
      if (!table || !listing.corrected) return listing.corrected;
      const named = table.segments.filter(({ label }) => label).length;
      const counts = [table.segments.length, checkedIn(table), named];
      return counts.join() !== [listing.segments, listing.checked, listing.named].join();
    });
  }

  private async ask(): Promise<void> {
    const { session } = this;
    try {
      const { recordings } = await session.api.tables();
      const ofServer = recordings.flatMap(({ id, table }) =>
        table ? [[id, { table: tableOf(table), comments: table.comments }] as const] : [],
      );
      const open = new Set(session.recordings.value.map(({ id }) => id));
      batch(() => {
        this.ofPage.value = new Map([...this.ofPage.value].filter(([id]) => open.has(id)));
        this.ofServer.value = new Map(ofServer);
        this.ready.value = true;
      });
      this.missed = false;
      session.bulletin.solved("tables");
    } catch (error) {
      this.missed = error instanceof Unreachable || (error as Refused).status === 403;
      if (!this.missed) session.bulletin.problem(explain(error), "tables"); // else it is told
    }
  }
}
