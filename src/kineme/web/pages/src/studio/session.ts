/**
 * What the studio has at hand: the folder, the open recordings, the line to the server.
 *
 * A recording that was opened stays with the session, shown or not, so that its
 * edits are sent even after it was closed.
 */

import { computed, effect, signal } from "@preact/signals";
import type { Changed, Comparison, CompareRequest, Listing, Preview, State } from "../messages";
import type { Motion } from "../motion";
import { loadMotion, type OpenRecording, type OtherResult, type Store } from "../store";
import { type Api, explain, Refused, RETRY, Unreachable } from "./server/api";
import { EditedRecording } from "./editing/editedRecording";
import { ServerData } from "./server/serverData";
import { shareToken } from "./server/token";
import { Bulletin } from "./news";

/** How far a recording is. */
export type Status = "new" | "corrected" | "checked";

/** A preset and its constants. */
export interface Choice {
  preset: string;
  values: Record<string, number>;
}

export interface Proposal {
  choice: Choice;
  keep: boolean;
  preview: Preview;
  shown: OtherResult;
  /** Of the table that it would take the place of. */
  revision: number;
}

const NO_ANSWER =
  "The studio’s server does not answer. What is shown is saved; edits wait here until it is back.";
const STARTED_ANEW =
  "The studio was started anew. Open the address it printed: then this tab goes on, too.";

export class Session {
  readonly state = signal<State | null>(null);
  /** Why the server cannot be worked with, in a sentence; null while it can. */
  readonly trouble = signal<string | null>(null);
  /** The recording that is being opened. */
  readonly opening = signal<string | null>(null);
  /** A segmentation that is shown, but not made; only as long as it lies beside the table. */
  readonly proposal = computed(() =>
    this.proposed.value?.shown === this.store.other.value ? this.proposed.value : null,
  );
  /** Another result beside the shown one. */
  readonly comparison = computed(() =>
    this.proposal.value ? null : (this.compared.value.get(this.store.other.value!) ?? null),
  );
  readonly bulletin = new Bulletin();
  readonly edited = computed(() => {
    const id = this.store.recording.value?.id;
    return this.recordings.value.find((edited) => edited.id === id);
  });
  /** What the list of recordings shows. */
  readonly search = signal("");
  readonly wanted = signal<Status | "">("");
  readonly listed = computed(() => {
    const text = this.search.value.trim().toLowerCase();
    const all = this.state.value?.recordings ?? [];
    return all.filter(
      (each) =>
        each.name.toLowerCase().includes(text) &&
        (!this.wanted.value || this.statusOf(each) === this.wanted.value),
    );
  });
  /** Recordings whose edits wait for a decision. */
  readonly held = computed(() => this.recordings.value.filter((edited) => edited.held.value));
  /** Edits of all recordings that the server has not confirmed. */
  readonly unsent = computed(() => this.recordings.value.flatMap((edited) => edited.unsent()));

  private readonly recordings = signal<EditedRecording[]>([]);
  private readonly proposed = signal<Proposal | null>(null);
  private readonly compared = signal(new WeakMap<OtherResult, Comparison>());
  private asked = 0;
  private retrying = 0;
  private begun = false;

  constructor(
    readonly api: Api,
    readonly store: Store,
  ) {}

  /** @param announced once other tabs know of this one, which edits are taken over by */
  async start(announced: Promise<void>): Promise<void> {
    shareToken(this.api);
    const [told] = await Promise.all([this.refresh(), announced]);
    if (told) await this.begin();
  }

  /** The folder as it is now; whether the server told. */
  async refresh(): Promise<boolean> {
    try {
      this.state.value = await this.api.state();
      return true;
    } catch (error) {
      if (error instanceof Unreachable) this.lost();
      else if (error instanceof Refused && error.status === 403) this.lost(STARTED_ANEW);
      else this.bulletin.problem(explain(error));
      return false;
    }
  }

  /** Shows a recording, alone or beside those shown. */
  async open(id: string, { beside = false } = {}): Promise<void> {
    const { store } = this;
    if (this.opening.value === id) return;
    const index = store.opened.value.findIndex((each) => each.recording.value.id === id);
    if (index >= 0) {
      store.show(index);
      if (!beside) this.closeOthers(id);
      return;
    }
    this.opening.value = id;
    try {
      const opened = await this.fetch(id);
      if (this.opening.value !== id) return; // another one has been chosen since
      if (!beside) store.playhead.value = 0;
      store.add(opened);
      if (!beside) this.closeOthers(id);
      this.bulletin.solved("open");
      void this.refresh();
      await loadMotion(opened);
    } catch (error) {
      this.bulletin.problem(explain(error), "open");
    } finally {
      if (this.opening.value === id) this.opening.value = null;
    }
  }

  /** Opens the next recording of the list, or the one before. */
  async openNext(by: 1 | -1): Promise<void> {
    const { value: listed } = this.listed;
    const id = this.opening.value ?? this.store.recording.value?.id;
    const at = listed.findIndex((each) => each.id === id);
    const next = at < 0 ? listed[0] : listed[at + by];
    if (next) await this.open(next.id);
    else
      this.bulletin.tell(by > 0 ? "This is the last recording." : "This is the first recording.");
  }

  close(id: string): void {
    const index = this.store.opened.value.findIndex((each) => each.recording.value.id === id);
    if (index >= 0) this.store.close(index);
    this.forgetClosed();
  }

  /** How far a recording is: as it is shown, else as the folder was told to be. */
  statusOf(listing: Listing): Status {
    const open = this.recordings.value.find((edited) => edited.id === listing.id);
    const { saved, segmentation } = open?.confirmed.value ?? {};
    if (segmentation && saved)
      return status(segmentation.segments.length, segmentation.checked.length);
    return listing.corrected ? status(listing.segments, listing.checked) : "new";
  }

  /** Shows what a segmentation would make of the table, which stays as it is. */
  async propose(choice: Choice, keep: boolean): Promise<void> {
    const edited = this.edited.value;
    if (!edited) return;
    const turn = ++this.asked;
    const { revision } = edited.confirmed.peek();
    try {
      const request = { preset: choice.preset, parameters: choice.values, keep };
      const preview = await this.api.preview(edited.id, request);
      if (turn !== this.asked || this.edited.peek() !== edited) return;
      const shown = { name: "Preview", segmentation: preview.segmentation, marked: true };
      this.proposed.value = { choice, keep, preview, shown, revision };
      this.store.other.value = shown;
      this.bulletin.solved("preview");
    } catch (error) {
      if (turn === this.asked) this.bulletin.problem(explain(error), "preview");
    }
  }

  /** Makes the shown segmentation the table. */
  apply(): void {
    const { value: proposal } = this.proposal;
    if (!proposal) return;
    const { choice, keep } = proposal;
    this.discard();
    void this.edited.value?.edit({
      kind: "segment",
      preset: choice.preset,
      parameters: choice.values,
      keep,
    });
  }

  discard(): void {
    this.asked += 1;
    if (this.proposal.value) this.store.other.value = null;
    this.proposed.value = null;
  }

  /** Lays another result below the shown one; whether there is one. */
  async compare(request: CompareRequest): Promise<boolean> {
    const edited = this.edited.value;
    if (!edited) return false;
    try {
      this.lay(await this.api.compare(edited.id, request));
      this.bulletin.solved("compare");
      return true;
    } catch (error) {
      this.bulletin.problem(explain(error), "compare");
      return false;
    }
  }

  /** Lays a result below the shown one. */
  lay(comparison: Comparison, marked = false): void {
    const shown = { name: comparison.name, segmentation: comparison.segmentation, marked };
    this.compared.value.set(shown, comparison);
    this.store.other.value = shown;
  }

  stopComparing(): void {
    this.store.other.value = null;
  }

  /** Nobody answers, or not to us: ask again every second until that has changed. */
  lost(reason = NO_ANSWER): void {
    this.trouble.value = reason;
    if (!this.retrying) this.retrying = window.setInterval(() => void this.recover(), RETRY);
  }

  /** The server is there, maybe another one: what was missed is asked for, what waits is sent. */
  private async recover(): Promise<void> {
    if (!(await this.refresh())) return;
    window.clearInterval(this.retrying);
    this.retrying = 0;
    this.trouble.value = null;
    if (!this.begun) await this.begin();
    else for (const edited of this.recordings.value) await edited.resume();
  }

  /** Opens what was open before, and listens for changes from then on. */
  private async begin(): Promise<void> {
    this.begun = true;
    this.api.listen(
      (change) => void this.changed(change),
      (up) => void (up ? this.recover() : this.refresh()),
    );
    const { recordings } = this.state.value!;
    const known = new Set(recordings.map((each) => each.id));
    const before = fromAddress().filter((id) => known.has(id));
    const first = before.length || known.size > 1 ? before : known;
    for (const id of first) await this.open(id, { beside: true });
    effect(() => toAddress(this.store.opened.value));
  }

  private async fetch(id: string): Promise<OpenRecording> {
    const data = new ServerData(this.api, id).askAhead();
    const edited =
      this.recordings.value.find((each) => each.id === id) ??
      (await EditedRecording.open(id, {
        api: this.api,
        folder: this.state.value?.folder ?? "",
        lost: () => this.lost(),
        tell: (text, undo) => this.bulletin.tell(text, undo),
      }));
    if (!this.recordings.value.includes(edited))
      this.recordings.value = [...this.recordings.value, edited];
    return { data, recording: edited.confirmed, motion: signal<Motion | null>(null) };
  }

  /** Recordings that are neither shown nor have edits on their way need no memory. */
  private forgetClosed(): void {
    const shown = new Set(this.store.opened.value.map((each) => each.recording.peek().id));
    const [kept, gone] = [[] as EditedRecording[], [] as EditedRecording[]];
    for (const edited of this.recordings.value)
      (shown.has(edited.id) || edited.waiting.peek().length ? kept : gone).push(edited);
    for (const edited of gone) edited.close();
    if (gone.length) this.recordings.value = kept;
  }

  private closeOthers(id: string): void {
    for (const { recording } of this.store.opened.value)
      if (recording.value.id !== id) this.close(recording.value.id);
  }

  private async changed(change: Changed): Promise<void> {
    const edited = this.recordings.value.find((each) => each.id === change.recording);
    if (edited) await edited.changed(change.revision);
    else await this.refresh();
  }
}

function status(segments: number, checked: number): Status {
  return checked > 0 && checked >= segments ? "checked" : "corrected";
}

/** The recordings named in the address, so that a reload finds them, and the server ahead of it. */
function fromAddress(): string[] {
  return new URLSearchParams(location.search).getAll("open");
}

function toAddress(opened: OpenRecording[]): void {
  const address = new URLSearchParams(location.search);
  address.delete("open");
  for (const each of opened) address.append("open", each.recording.peek().id);
  history.replaceState(null, "", `?${address}`);
}
