/** Manage the folder, the recordings (until their edits are sent) and the connection. */
import { computed, effect, signal, untracked } from "@preact/signals";
import type { Changed, ReadRequest, Recording, State } from "../messages";
import { loadMotion, type OpenRecording } from "../recordingData";
import type { Store } from "../store";
import {
  RETRY_INTERVAL,
  Refused,
  ServerData,
  Unreachable,
  explainError,
  getUnreadPeople,
  needsPoses,
  shareToken,
  type Api,
} from "./server/api";
import { Comparisons, PeopleComparison } from "./editing/comparisons";
import { EditedRecording } from "./editing/editedRecording";
import { readOpenIds, readStartTime, writeOpenIds } from "./server/address";
import { Notifications } from "./notifications";
import { RecordingList } from "./folder/recordingList";

const NO_ANSWER =
  "The studio’s server does not answer. What is shown is saved; nothing can be edited until it is back.";
const STARTED_ANEW =
  "The studio was started anew. Open the address it printed: then this tab goes on, too.";

/** Problems that disappear when the table or the recording changes. */
const OF_TABLE = ["preview", "compare"];
const OF_RECORDING = ["video", "versions", "clips", "export"];

/** A recording that could not be read. */
interface Unread {
  id: string;
  name: string;
  people: readonly string[];
}

export class Session {
  readonly state = signal<State | null>(null);
  /** Why the server is unavailable, as a sentence; null if it is available. */
  readonly trouble = signal<string | null>(null);
  /** Id of the recording being opened. */
  readonly opening = signal<string | null>(null);
  /** The recording that could not be read and its people. */
  readonly unread = signal<Unread | null>(null);
  /** Id of the video whose poses must be estimated first. */
  readonly videoWithoutPoses = signal<string | null>(null);
  /** Question which of several people to show; empty if none is asked. */
  readonly question = computed(() => {
    const { people = [], name } = this.unread.value ?? {};
    const many = `${people.length} people are in ${name}: choose one of them on the left, or all.`;
    return people.length > 1 ? many : "";
  });
  readonly notifications: Notifications;
  /** Open recordings and closed ones with unsent edits. */
  readonly recordings = signal<EditedRecording[]>([]);
  readonly list = new RecordingList(this.state, this.recordings);
  readonly edited = computed(() => {
    const id = this.store.recording.value?.id;
    return this.recordings.value.find((edited) => edited.id === id);
  });
  /** Recordings whose edits are blocked. */
  readonly blocked = computed(() => this.recordings.value.filter((edited) => edited.blocked.value));
  /** Descriptions of all unconfirmed edits. */
  readonly unsent = computed(() =>
    this.recordings.value.flatMap((edited) => edited.describeUnsent()),
  );

  /** Whether the server is segmenting the active recording. */
  readonly segmenting = computed(() => {
    const { edited } = this;
    const finding = edited.value?.busy.value || edited.value?.confirmed.value.finding;
    return Boolean(finding) || this.comparisons.draft.value !== null;
  });

  readonly comparisons: Comparisons;
  readonly people: PeopleComparison;
  /** Revisions announced for recordings that are still loading. */
  private readonly missedRevisions = new Map<string, number>();
  private retryTimer = 0;
  private hasStarted = false;

  constructor(
    readonly api: Api,
    readonly store: Store,
  ) {
    this.notifications = new Notifications(() => getTableKey(store.recording.value));
    this.comparisons = new Comparisons(this);
    this.people = new PeopleComparison(this);
    const clearOnChange = (topics: readonly string[], inFront: () => unknown): void =>
      void effect(() => {
        void inFront();
        untracked(() => topics.forEach((what) => this.notifications.clearProblem(what)));
      });
    clearOnChange(OF_TABLE, () => getTableKey(store.recording.value));
    clearOnChange(OF_RECORDING, () => store.recording.value?.id);
  }

  /** @param announced resolves once this tab's lock is held, so that edits can be taken over */
  async start(announced: Promise<void>): Promise<void> {
    shareToken(this.api);
    const [answered] = await Promise.all([this.refresh(), announced]);
    if (answered) await this.openInitial();
  }

  /** Reload the folder; return whether the server answered. */
  async refresh(): Promise<boolean> {
    try {
      this.state.value = await this.api.loadState();
      this.notifications.clearProblem("folder");
      return true;
    } catch (error) {
      if (error instanceof Unreachable) this.handleLostConnection();
      else if (error instanceof Refused && error.status === 403)
        this.handleLostConnection(STARTED_ANEW);
      else this.notifications.reportProblem(explainError(error), "folder");
      return false;
    }
  }

  /** Show a recording, alone or with the open ones; `shown` is called before its motion loads. */
  async open(id: string, { beside = false, shown = (): void => undefined } = {}): Promise<void> {
    const { store } = this;
    if (this.opening.value === id) return;
    const index = store.findIndex(id);
    if (index >= 0) {
      store.show(index);
      this.notifications.clearProblem("open");
      if (!beside) this.closeOthers(id, store.people.value);
      shown();
      return;
    }
    this.opening.value = id;
    this.unread.value = null;
    this.videoWithoutPoses.value = null;
    try {
      const opened = await this.loadOpened(id);
      if (this.opening.value !== id) return; // another one was chosen meanwhile
      if (!beside) store.playhead.value = 0;
      store.add(opened);
      if (!beside) this.closeOthers(id);
      shown();
      this.notifications.clearProblem("open");
      void this.refresh();
      await loadMotion(opened);
    } catch (error) {
      // It was cancelled, or another one was chosen.
      if (this.opening.value !== id && store.findIndex(id) < 0) return;
      if (needsPoses(error)) {
        this.videoWithoutPoses.value = id;
        this.notifications.clearProblem("open");
        return void this.refresh();
      }
      const isAsked = this.handleUnread(id, error);
      if (!isAsked || store.opened.value.length)
        // otherwise the viewer asks
        this.notifications.reportProblem(
          isAsked ? this.question.value : explainError(error),
          "open",
        );
    } finally {
      if (this.opening.value === id) this.opening.value = null;
    }
  }

  /** Change how a file is read and show it, or the requested people. */
  async readAs(id: string, request: ReadRequest): Promise<void> {
    let asked: string[];
    try {
      asked = await this.api.readAs(id, request);
    } catch (error) {
      const isAsked = this.handleUnread(id, error);
      this.notifications.clearProblem("open");
      this.notifications.reportProblem(
        isAsked ? this.question.value : explainError(error),
        "reading",
      );
      return;
    }
    for (const what of ["reading", "open"]) this.notifications.clearProblem(what);
    const { value: recording } = this.store.recording;
    const shown = recording?.id === id ? this.store.people.value : [];
    const before = shown.map((each) => each.recording.value.id);
    const isSame = asked.length === 1 && asked[0] === id;
    for (const each of [id, ...before]) this.close(each);
    await this.refresh(); // each person is listed separately
    await this.openTogether(isSame && before.length ? before : asked);
  }

  /** Open recordings together and activate the first. */
  private async openTogether(ids: readonly string[]): Promise<void> {
    for (const [i, id] of ids.entries()) await this.open(id, { beside: i > 0 });
    const first = this.store.findIndex(ids[0]);
    if (ids.length > 1 && first >= 0) this.store.show(first);
  }

  /** Show the reading options of an unread recording; return whether to ask for a person. */
  private handleUnread(id: string, error: unknown): boolean {
    const people = getUnreadPeople(error);
    const name = this.state.value?.recordings.find((each) => each.id === id)?.name;
    const before = this.unread.value?.id === id ? this.unread.value.people : [];
    if (people && name) this.unread.value = { id, name, people: people.length ? people : before };
    return (people?.length ?? 0) > 1 && this.question.value !== "";
  }

  /** Open the next or previous recording of the list. */
  async openNext(by: 1 | -1): Promise<void> {
    const { value: listed } = this.list.listed;
    const id = this.opening.value ?? this.store.recording.value?.id;
    const at = listed.findIndex((each) => each.id === id);
    const next = at < 0 ? listed[0] : listed[at + by];
    if (next) await this.open(next.id);
    else
      this.notifications.tell(
        by > 0 ? "This is the last recording." : "This is the first recording.",
      );
  }

  close(id: string): void {
    const index = this.store.findIndex(id);
    if (index >= 0) this.store.close(index);
    this.forgetClosed();
  }

  /** Cancel the opening of a recording. */
  stopOpening(): void {
    this.opening.value = null;
  }

  /** Cancel the server's computation; close a recording that is still being read. */
  cancel(): void {
    this.comparisons.cancel();
    const { value: edited } = this.edited;
    edited?.cancel();
    if (edited?.confirmed.value.being_read) this.close(edited.id);
  }

  /** Report a lost connection and retry every second. */
  handleLostConnection(reason = NO_ANSWER): void {
    this.trouble.value = reason;
    if (!this.retryTimer)
      this.retryTimer = window.setInterval(() => void this.recover(), RETRY_INTERVAL);
  }

  /** After a reconnect, reload what changed and send pending edits. */
  private async recover(): Promise<void> {
    if (!(await this.refresh())) return;
    window.clearInterval(this.retryTimer);
    this.retryTimer = 0;
    this.trouble.value = null;
    if (!this.hasStarted) await this.openInitial();
    else
      for (const edited of this.recordings.value) {
        await edited.resume();
        await this.renewMotion(edited.id);
      }
  }

  /** Restore the open recordings and listen to changes. */
  private async openInitial(): Promise<void> {
    this.hasStarted = true;
    this.api.listen(
      (change) => void this.handleChange(change),
      (up) => void (up ? this.recover() : this.refresh()),
    );
    addEventListener("focus", () => void this.refresh()); // files may have been added
    const { recordings } = this.state.value!;
    const listed = new Set(recordings.map((each) => each.id));
    const before = readOpenIds().filter((id) => listed.has(id));
    const files = new Set(recordings.map((each) => each.file));
    if (before.length || files.size !== 1)
      for (const id of before) await this.open(id, { beside: true });
    else await this.openTogether([...listed]);
    if (readStartTime()) this.store.seek(readStartTime());
    effect(() => writeOpenIds(this.store.opened.value));
  }

  private async loadOpened(id: string): Promise<OpenRecording> {
    const data = new ServerData(this.api, id);
    const edited =
      this.recordings.value.find((each) => each.id === id) ??
      (await EditedRecording.open(id, {
        api: this.api,
        folder: this.state.value?.folder ?? "",
        isOffline: () => this.trouble.peek() !== null,
        onConnectionLost: () => this.handleLostConnection(),
        tell: (text, refused) => this.notifications.tell(this.addName(id, text), refused),
        warn: (text) => this.notifications.reportProblem(this.addName(id, text), "edit"),
      }));
    if (!this.recordings.value.includes(edited)) {
      this.recordings.value = [...this.recordings.value, edited];
      const revision = this.missedRevisions.get(id) ?? 0;
      if (revision > edited.confirmed.peek().revision) void edited.handleChange(revision);
      this.missedRevisions.delete(id);
    }
    return { data, recording: edited.confirmed, motion: signal(null), keypoints: signal(null) };
  }

  /** Prefix a message with the recording's name unless it is active. */
  private addName(id: string, text: string): string {
    const edited = this.recordings.peek().find((each) => each.id === id);
    const isInFront = !edited || this.edited.peek() === edited;
    return isInFront ? text : `${edited.confirmed.peek().name}: ${text}`;
  }

  /** Drop recordings that are neither shown nor have unsent edits. */
  private forgetClosed(): void {
    const shown = new Set(this.store.opened.value.map((each) => each.recording.peek().id));
    const [kept, closed] = [[] as EditedRecording[], [] as EditedRecording[]];
    for (const edited of this.recordings.value)
      (shown.has(edited.id) || edited.hasPending() ? kept : closed).push(edited);
    for (const edited of closed) edited.close();
    if (closed.length) this.recordings.value = kept;
  }

  /** Close all recordings except one and `kept`. */
  private closeOthers(id: string, kept: readonly OpenRecording[] = []): void {
    for (const each of this.store.opened.value)
      if (each.recording.value.id !== id && !kept.includes(each))
        this.close(each.recording.value.id);
  }

  private async handleChange(change: Changed): Promise<void> {
    const edited = this.recordings.value.find((each) => each.id === change.recording);
    if (!edited) {
      this.missedRevisions.set(change.recording, change.revision);
      return void (await this.refresh());
    }
    await edited.handleChange(change.revision);
    await this.renewMotion(edited.id);
  }

  /** Reload a recording's motion: large recordings are read in parts. */
  private async renewMotion(id: string): Promise<void> {
    const opened = this.store.opened.value[this.store.findIndex(id)];
    try {
      if (opened?.motion.value) await loadMotion(opened);
    } catch (error) {
      this.notifications.reportProblem(explainError(error), "open");
    }
  }
}

/** Return a key of the active table, which changes with each edit. */
function getTableKey(recording: Recording | undefined): string {
  return recording ? `${recording.id} ${recording.revision}` : "";
}
