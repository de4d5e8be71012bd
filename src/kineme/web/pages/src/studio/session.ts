/**
 * What the studio has at hand: the folder, the open recordings, the line to the server.
 *
 * A recording that was opened stays with the session, shown or not, so that its
 * edits are sent even after it was closed.
 */

import { computed, effect, signal, untracked } from "@preact/signals";
import type { Changed, ReadRequest, Recording, State } from "../messages";
import { loadMotion, type OpenRecording } from "../opened";
import type { Store } from "../store";
import { type Api, explain, Refused, RETRY, Unreachable } from "./server/api";
import { Beside } from "./editing/beside";
import { needsPoses, notRead } from "./server/answers";
import { EditedRecording } from "./editing/editedRecording";
import { openInAddress, openToAddress, secondsInAddress } from "./server/address";
import { ServerData } from "./server/serverData";
import { shareToken } from "./server/token";
import { Bulletin } from "./news";
import { People } from "./people/people";
import { RecordingList } from "./recordingList";

const NO_ANSWER =
  "The studio’s server does not answer. What is shown is saved; nothing can be edited until it is back.";
const STARTED_ANEW =
  "The studio was started anew. Open the address it printed: then this tab goes on, too.";

/** Problems of a table, and of a recording, which are none of the next one's. */
const OF_TABLE = ["preview", "compare"];
const OF_RECORDING = ["video", "versions", "clips", "export"];

/** A recording that was not read as it was told to be. */
export interface Unread {
  id: string;
  name: string;
  people: readonly string[];
}

export class Session {
  readonly state = signal<State | null>(null);
  /** Why the server cannot be worked with, in a sentence; null while it can. */
  readonly trouble = signal<string | null>(null);
  /** The recording that is being opened. */
  readonly opening = signal<string | null>(null);
  /** The recording that could not be read, and the people in it. */
  readonly unread = signal<Unread | null>(null);
  /** The video that could not be opened because its poses are to be estimated first. */
  readonly needing = signal<string | null>(null);
  /** Who of several people is to be seen, in a sentence; empty where nothing is asked. */
  readonly question = computed(() => {
    const { people = [], name } = this.unread.value ?? {};
    const many = `${people.length} people are in ${name}: choose one of them on the left, or all.`;
    return people.length > 1 ? many : "";
  });
  readonly bulletin: Bulletin;
  /** Those that are open, and those whose edits are on their way. */
  readonly recordings = signal<EditedRecording[]>([]);
  readonly list = new RecordingList(this.state, this.recordings);
  readonly edited = computed(() => {
    const id = this.store.recording.value?.id;
    return this.recordings.value.find((edited) => edited.id === id);
  });
  /** Recordings whose edits wait for a decision. */
  readonly blocked = computed(() => this.recordings.value.filter((edited) => edited.blocked.value));
  /** Edits of all recordings that the server has not confirmed. */
  readonly unsent = computed(() => this.recordings.value.flatMap((edited) => edited.unsent()));

  /** Whether the server is finding segments of the recording in front. */
  readonly segmenting = computed(() => {
    const { edited } = this;
    const finding = edited.value?.busy.value || edited.value?.confirmed.value.finding;
    return Boolean(finding) || this.beside.draft.value !== null;
  });

  readonly beside: Beside;
  readonly people: People;
  /** Revisions that were announced of recordings while these were still on their way here. */
  private readonly missed = new Map<string, number>();
  private retrying = 0;
  private started = false;

  constructor(
    readonly api: Api,
    readonly store: Store,
  ) {
    this.bulletin = new Bulletin(() => tableOf(store.recording.value));
    this.beside = new Beside(this);
    this.people = new People(this);
    const over = (topics: readonly string[], inFront: () => unknown): void =>
      void effect(() => {
        void inFront();
        untracked(() => topics.forEach((what) => this.bulletin.solved(what)));
      });
    over(OF_TABLE, () => tableOf(store.recording.value));
    over(OF_RECORDING, () => store.recording.value?.id);
  }

  /** @param announced once other tabs know of this one, which edits are taken over by */
  async start(announced: Promise<void>): Promise<void> {
    shareToken(this.api);
    const [answered] = await Promise.all([this.refresh(), announced]);
    if (answered) await this.begin();
  }

  /** The folder as it is now; whether the server told. */
  async refresh(): Promise<boolean> {
    try {
      this.state.value = await this.api.state();
      this.bulletin.solved("folder");
      return true;
    } catch (error) {
      if (error instanceof Unreachable) this.lost();
      else if (error instanceof Refused && error.status === 403) this.lost(STARTED_ANEW);
      else this.bulletin.problem(explain(error), "folder");
      return false;
    }
  }

  /** Shows a recording, alone or beside those shown; `shown` is called before its figure comes. */
  async open(id: string, { beside = false, shown = (): void => undefined } = {}): Promise<void> {
    const { store } = this;
    if (this.opening.value === id) return;
    const index = store.opened.value.findIndex((each) => each.recording.value.id === id);
    if (index >= 0) {
      store.show(index);
      this.bulletin.solved("open");
      if (!beside) this.closeOthers(id, store.people.value);
      shown();
      return;
    }
    this.opening.value = id;
    this.unread.value = null;
    this.needing.value = null;
    try {
      const opened = await this.opened(id);
      if (this.opening.value !== id) return; // another one has been chosen since
      if (!beside) store.playhead.value = 0;
      store.add(opened);
      if (!beside) this.closeOthers(id);
      shown();
      this.bulletin.solved("open");
      void this.refresh();
      await loadMotion(opened);
    } catch (error) {
      const isShown = store.opened.value.some((each) => each.recording.value.id === id);
      if (this.opening.value !== id && !isShown) return; // cancelled, or another one chosen
      if (needsPoses(error)) {
        this.needing.value = id;
        this.bulletin.solved("open");
        return void this.refresh();
      }
      const isAsked = this.notRead(id, error);
      if (!isAsked || store.opened.value.length)
        // else the stage asks
        this.bulletin.problem(isAsked ? this.question.value : explain(error), "open");
    } finally {
      if (this.opening.value === id) this.opening.value = null;
    }
  }

  /** Reads a file otherwise from now on, and shows it, or the people of it who are asked for. */
  async readAs(id: string, request: ReadRequest): Promise<void> {
    let asked: string[];
    try {
      asked = await this.api.readAs(id, request);
    } catch (error) {
      const isAsked = this.notRead(id, error);
      this.bulletin.solved("open");
      this.bulletin.problem(isAsked ? this.question.value : explain(error), "reading");
      return;
    }
    for (const what of ["reading", "open"]) this.bulletin.solved(what);
    const { value: recording } = this.store.recording;
    const shown = recording?.id === id ? this.store.people.value : [];
    const before = shown.map((each) => each.recording.value.id);
    const isSame = asked.length === 1 && asked[0] === id;
    for (const each of [id, ...before]) this.close(each);
    await this.refresh(); // of several people each is listed now
    await this.openTogether(isSame && before.length ? before : asked);
  }

  /** Shows recordings beside each other, the first of them in front. */
  private async openTogether(ids: readonly string[]): Promise<void> {
    for (const [i, id] of ids.entries()) await this.open(id, { beside: i > 0 });
    const { opened } = this.store;
    const first = opened.value.findIndex((each) => each.recording.value.id === ids[0]);
    if (ids.length > 1 && first >= 0) this.store.show(first);
  }

  /** Offers to say how a recording is to be read, where that is what is wrong; whether of people. */
  private notRead(id: string, error: unknown): boolean {
    const people = notRead(error);
    const name = this.state.value?.recordings.find((each) => each.id === id)?.name;
    const before = this.unread.value?.id === id ? this.unread.value.people : [];
    if (people && name) this.unread.value = { id, name, people: people.length ? people : before };
    return (people?.length ?? 0) > 1 && this.question.value !== "";
  }

  /** Opens the next recording of the list, or the one before. */
  async openNext(by: 1 | -1): Promise<void> {
    const { value: listed } = this.list.listed;
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

  /** Stops waiting for the recording that is being opened. */
  stopOpening(): void {
    this.opening.value = null;
  }

  /** Has the server leave what it is finding; what is there stays, what is being read is closed. */
  cancel(): void {
    this.beside.cancel();
    const { value: edited } = this.edited;
    edited?.cancel();
    if (edited?.confirmed.value.being_read) this.close(edited.id);
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
    if (!this.started) await this.begin();
    else
      for (const edited of this.recordings.value) {
        await edited.resume();
        await this.renewMotion(edited.id);
      }
  }

  /** Opens what was open before, and listens for changes from then on. */
  private async begin(): Promise<void> {
    this.started = true;
    this.api.listen(
      (change) => void this.changed(change),
      (up) => void (up ? this.recover() : this.refresh()),
    );
    addEventListener("focus", () => void this.refresh()); // files may have come meanwhile
    const { recordings } = this.state.value!;
    const listed = new Set(recordings.map((each) => each.id));
    const before = openInAddress().filter((id) => listed.has(id));
    const files = new Set(recordings.map((each) => each.file));
    if (before.length || files.size !== 1)
      for (const id of before) await this.open(id, { beside: true });
    else await this.openTogether([...listed]);
    if (secondsInAddress()) this.store.seek(secondsInAddress());
    effect(() => openToAddress(this.store.opened.value));
  }

  private async opened(id: string): Promise<OpenRecording> {
    const data = new ServerData(this.api, id);
    const edited =
      this.recordings.value.find((each) => each.id === id) ??
      (await EditedRecording.open(id, {
        api: this.api,
        folder: this.state.value?.folder ?? "",
        isAway: () => this.trouble.peek() !== null,
        lost: () => this.lost(),
        tell: (text, refused) => this.bulletin.tell(this.withName(id, text), refused),
        warn: (text) => this.bulletin.problem(this.withName(id, text), "edit"),
      }));
    if (!this.recordings.value.includes(edited)) {
      this.recordings.value = [...this.recordings.value, edited];
      const revision = this.missed.get(id) ?? 0;
      if (revision > edited.confirmed.peek().revision) void edited.changed(revision);
      this.missed.delete(id);
    }
    return { data, recording: edited.confirmed, motion: signal(null), keypoints: signal(null) };
  }

  /** News of a recording; those of one that is not in front are told with its name. */
  private withName(id: string, text: string): string {
    const edited = this.recordings.peek().find((each) => each.id === id);
    const isInFront = !edited || this.edited.peek() === edited;
    return isInFront ? text : `${edited.confirmed.peek().name}: ${text}`;
  }

  /** Recordings that are neither shown nor have edits on their way need no memory. */
  private forgetClosed(): void {
    const shown = new Set(this.store.opened.value.map((each) => each.recording.peek().id));
    const [kept, closed] = [[] as EditedRecording[], [] as EditedRecording[]];
    for (const edited of this.recordings.value)
      (shown.has(edited.id) || edited.isOwing() ? kept : closed).push(edited);
    for (const edited of closed) edited.close();
    if (closed.length) this.recordings.value = kept;
  }

  /** Closes all but one, and people who are shown with that one. */
  private closeOthers(id: string, kept: readonly OpenRecording[] = []): void {
    for (const each of this.store.opened.value)
      if (each.recording.value.id !== id && !kept.includes(each))
        this.close(each.recording.value.id);
  }

  private async changed(change: Changed): Promise<void> {
    const edited = this.recordings.value.find((each) => each.id === change.recording);
    if (!edited) {
      this.missed.set(change.recording, change.revision);
      return void (await this.refresh());
    }
    await edited.changed(change.revision);
    await this.renewMotion(edited.id);
  }

  /** The poses of a recording as it is now: those of a large one come bit by bit. */
  private async renewMotion(id: string): Promise<void> {
    const opened = this.store.opened.value.find((each) => each.recording.value.id === id);
    try {
      if (opened?.motion.value) await loadMotion(opened);
    } catch (error) {
      this.bulletin.problem(explain(error), "open");
    }
  }
}

/** Which table is in front: another one after each edit. */
function tableOf(recording: Recording | undefined): string {
  return recording ? `${recording.id} ${recording.revision}` : "";
}
