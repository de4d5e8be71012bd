/**
 * An open recording: the server's table, and a queue of edits. Edits are sent one after the other
 * and the page shows the table of the last answer. Each edit has an id, so that the server
 * recognises a repeated request. While an edit waits, it follows the segments it names. It leaves
 * the queue once the server has answered. Without a connection the queue is kept, even if the tab
 * closes, and accepts no more edits. The same holds if the server's table is not the edited one,
 * until the user decides.
 */
import { batch, computed, effect, signal, type Signal } from "@preact/signals";
import type { Edit, Edited, Recording, Segments } from "../../messages";
import { Refused, Unreachable, type Api } from "../server/api";
import {
  applyChange,
  describeEdit,
  describeResult,
  isLossNote,
  replacesTable,
  retargetEdit,
} from "./edits";

const MISSING = "what it was made on is not there any more";
const AWAY = "Not done: the studio’s server does not answer.";
const UNDECIDED = "Not done: first choose what becomes of the edits above.";

/** An entry of the queue: an edit, or a command that needs the table of the edits before it. */
type Turn = Unsent | (() => void);

interface RecordingContext {
  api: Api;
  folder: string;
  /** Return whether the last request got no answer. */
  isOffline(): boolean;
  /** Report that the server did not answer or rejected the token. */
  onConnectionLost(): void;
  /** Show a message for a few seconds. */
  tell(text: string, refused?: boolean): void;
  /** Show a message until the user dismisses it. */
  warn(text: string): void;
}

export class EditedRecording {
  readonly confirmed: Signal<Recording>;
  /** Why the queue is blocked, as a sentence; null if it is not. */
  readonly blocked = signal<string | null>(null);
  /** Whether the server is computing another table. */
  readonly busy = computed(() => this.edits.value.some(({ edit }) => replacesTable(edit)));

  private readonly queue = signal<Turn[]>([]);
  private readonly edits = computed(() => this.queue.value.filter(isEdit));
  private sending: Promise<void> | null = null;
  /** Whether a queued command runs; its edits were accepted when it was queued. */
  private isRunningCommand = false;
  private announcedRevision = 0;
  /** Id of a cancelled edit. */
  private cancelledName = "";
  private readonly stopStoring: () => void;

  constructor(
    recording: Recording,
    private readonly context: RecordingContext,
  ) {
    this.confirmed = signal(recording);
    this.stopStoring = effect(() => storeUnsent(context.folder, recording.id, this.edits.value));
  }

  /** Open a recording, with edits that an earlier tab could not send. */
  static async open(id: string, around: RecordingContext): Promise<EditedRecording> {
    const recording = await around.api.loadRecording(id);
    const left = await takeOverUnsent(around.folder, id);
    const edited = new EditedRecording(recording, around);
    edited.queue.value = left;
    if (left.length) void edited.send();
    return edited;
  }

  get id(): string {
    return this.confirmed.peek().id;
  }

  /** Return whether edits are possible; if not, say why. */
  acceptsEdits(): boolean {
    if (this.isRunningCommand) return true;
    const why = this.context.isOffline() ? AWAY : this.blocked.peek() === null ? "" : UNDECIDED;
    if (why) this.context.tell(why, true);
    if (why) this.refreshTable();
    return !why;
  }

  /**
   * Queue an edit. The promise resolves once it is applied, refused or blocked. `made` is called
   * when the resulting table is shown. An edit begun on an earlier `table` is retargeted to the
   * current one.
   */
  edit(wanted: Edit, made?: () => void, table?: Segments): Promise<void> {
    if (!this.acceptsEdits()) return Promise.resolve();
    const { segmentation, fps } = this.confirmed.peek();
    const edit = table ? retargetEdit(wanted, table, segmentation) : wanted;
    if (!edit) {
      this.context.warn(`Not made: ${describeEdit(wanted, fps)} (${MISSING}).`);
      return Promise.resolve();
    }
    const queue = this.queue.peek();
    const base = queue.length ? null : this.confirmed.peek().revision;
    this.queue.value = [...queue, { name: crypto.randomUUID(), edit, base, made }];
    return this.send();
  }

  /** Run a command once all queued edits are shown; at once if none waits. */
  runWhenShown(command: () => void): void {
    if (!this.sending) command();
    else if (this.acceptsEdits()) this.queue.value = [...this.queue.peek(), command];
  }

  /** Resolve once the queue is empty or blocked. */
  waitUntilSent(): Promise<void> {
    return this.sending ?? Promise.resolve();
  }

  /** Cancel the server's computation and the edit that waits for it. */
  cancel(): void {
    const first = this.edits.peek()[0];
    if (first && replacesTable(first.edit)) this.cancelledName = first.name;
    void this.context.api.cancel(this.id).catch(() => undefined); // then the edit is applied
  }

  undo(): void {
    void this.edit({ kind: "undo" });
  }

  /** After a reconnect, send pending edits or reload the recording. */
  async resume(): Promise<void> {
    if (this.sending) return;
    this.announcedRevision = 0;
    if (this.hasPending()) await this.send();
    else await this.reload();
  }

  /** React to a new revision, made by this page or another one. */
  async handleChange(revision: number): Promise<void> {
    this.announcedRevision = revision;
    if (this.sending || this.hasPending()) return;
    if (revision === this.confirmed.peek().revision) return;
    const wasSegmenting = this.confirmed.peek().finding;
    if (!(await this.reload())) return;
    const { segmentation, finding: isSegmenting, saved } = this.confirmed.peek();
    if (isSegmenting) return;
    if (wasSegmenting && saved) return; // this page's own result, reported late
    this.context.tell(
      wasSegmenting
        ? describeResult(segmentation)
        : "Another tab changed this table. The changed table is shown.",
    );
  }

  /** Apply the blocked edits to the current table. */
  retry(): void {
    this.rebase();
    this.blocked.value = null;
    void this.send();
  }

  /** Discard the blocked edits. */
  discardEdits(): void {
    batch(() => {
      this.queue.value = [];
      this.blocked.value = null;
    });
    void this.resume();
  }

  /** Return whether edits are queued. */
  hasPending(): boolean {
    return this.queue.peek().length > 0;
  }

  close(): void {
    this.stopStoring();
  }

  /** Describe the queued edits. */
  describeUnsent(): string[] {
    const { fps } = this.confirmed.value;
    return this.queue.value.map((each) =>
      isEdit(each) ? describeEdit(each.edit, fps) : "a key pressed since",
    );
  }

  private send(): Promise<void> {
    return (this.sending ??= this.sendAll());
  }

  private async sendAll(): Promise<void> {
    await Promise.resolve(); // lets `sending` be assigned first
    while (this.hasPending() && this.blocked.peek() === null) if (!(await this.sendFirst())) break;
    this.sending = null;
    if (this.announcedRevision > this.confirmed.peek().revision)
      await this.handleChange(this.announcedRevision);
  }

  /** Send the first entry; return whether the queue may continue. */
  private async sendFirst(): Promise<boolean> {
    const [first, ...rest] = this.queue.peek();
    if (!isEdit(first!)) {
      batch(() => {
        this.queue.value = []; // edits of the command precede the rest
        this.isRunningCommand = true;
        try {
          first?.();
        } finally {
          this.isRunningCommand = false;
          this.queue.value = [...this.queue.peek(), ...rest];
        }
      });
      return true;
    }
    if (first.isGone) return this.refuse(first, MISSING);
    const { name, edit, base, made } = first;
    const before = this.confirmed.peek();
    try {
      const revision = base ?? before.revision;
      const edited = await this.context.api.sendEdit(this.id, { revision, edit, name });
      const now = await this.applyAnswer(edited);
      batch(() => {
        this.queue.value = this.queue.peek().slice(1);
        this.show(now);
        made?.();
      });
      this.report(edit, now.segmentation, edited.notes);
      return true;
    } catch (error) {
      if (!(error instanceof Refused) || error.status === 403) this.context.onConnectionLost();
      else if (error.status === 400) return this.refuse(first, error.message);
      else if (error.status === 409) return this.reconsider(before, error.message);
      else this.blocked.value = error.message;
      return false;
    }
  }

  /** Return the recording after an edit; reload it if the answer refers to another revision. */
  private async applyAnswer({ change, segmentation, ...edited }: Edited): Promise<Recording> {
    const before = this.confirmed.peek();
    const isOurs = change?.of === before.revision;
    const table = isOurs ? applyChange(before.segmentation, change) : segmentation;
    if (!table) return this.context.api.loadRecording(this.id);
    const { revision, can_undo, can_redo, saved } = edited;
    const now = { revision, can_undo, can_redo, saved, finding: false };
    return { ...before, ...now, segmentation: table };
  }

  /** Show a recording and retarget the queued edits. */
  private show(now: Recording): void {
    const { segmentation: before } = this.confirmed.peek();
    batch(() => {
      this.confirmed.value = now;
      this.queue.value = this.queue.peek().map((turn) => {
        if (!isEdit(turn) || turn.isGone) return turn;
        const edit = retargetEdit(turn.edit, before, now.segmentation);
        return edit ? { ...turn, edit } : { ...turn, isGone: true };
      });
    });
  }

  /** Remove a refused edit and an undo that was queued for it. */
  private refuse({ name, edit }: Unsent, reason: string): boolean {
    const rest = this.queue.peek().slice(1);
    const isStep = edit.kind === "undo" || edit.kind === "redo";
    const back = isStep ? -1 : findUndo(rest);
    this.queue.value = rest.filter((_, i) => i !== back);
    if (isStep || back >= 0 || name === this.cancelledName) this.context.tell(reason, true);
    else
      this.context.warn(`Not made: ${describeEdit(edit, this.confirmed.peek().fps)} (${reason}).`);
    this.refreshTable();
    return true;
  }

  /** Replace the table object, so that fields drop refused input. */
  private refreshTable(): void {
    const now = this.confirmed.peek();
    this.confirmed.value = { ...now, segmentation: { ...now.segmentation } };
  }

  /** Base the first edit on the current revision. */
  private rebase(): void {
    const [first, ...rest] = this.queue.peek();
    const base = this.confirmed.peek().revision;
    if (first && isEdit(first)) this.queue.value = [{ ...first, base }, ...rest];
  }

  /** On a revision conflict, continue if the table is unchanged, else block. */
  private async reconsider(before: Recording, reason: string): Promise<boolean> {
    if (!(await this.reload())) return false;
    const now = this.confirmed.peek();
    const [was, is] = [before, now].map((each) => JSON.stringify(each.segmentation.segments));
    const same = now.revision !== before.revision && was === is;
    if (same) this.rebase();
    else this.blocked.value = reason;
    return same;
  }

  private async reload(): Promise<boolean> {
    try {
      const before = this.confirmed.peek();
      const now = await this.context.api.loadRecording(this.id);
      const since = this.confirmed.peek(); // an edit may have been confirmed meanwhile
      if (since === before || now.revision >= since.revision) this.show(now);
      return true;
    } catch (error) {
      if (error instanceof Unreachable) this.context.onConnectionLost();
      else this.context.tell((error as Error).message, true);
      return false;
    }
  }

  private report(edit: Edit, segmentation: Segments, notes: string[]): void {
    const found = edit.kind === "segment" ? [describeResult(segmentation)] : [];
    const text = [...found, ...notes.filter((note) => !found.length || isLossNote(note))].join(" ");
    if (text) this.context.tell(text);
  }
}

function isEdit(turn: Turn): turn is Unsent {
  return typeof turn !== "function";
}

/** Return the index of the edit that undoes the refused one; -1 if none. */
function findUndo(later: readonly Turn[]): number {
  let made = 0; // edits since then that were not undone
  for (const [i, each] of later.entries()) {
    const isUndo = isEdit(each) && each.edit.kind === "undo";
    if (isUndo && made === 0) return i;
    made += isUndo ? -1 : 1;
  }
  return -1;
}

/** An unconfirmed edit. */
interface Unsent {
  name: string;
  edit: Edit;
  /** Revision it was made on; null: the result of the previous edit. */
  base: number | null;
  /** Whether a segment that it names no longer exists. */
  isGone?: boolean;
  /** Called when the resulting table is shown; not stored. */
  made?: (() => void) | undefined;
}

const PREFIX = "kineme.unsent";
let tab = sessionStorage.getItem("kineme.tab") ?? crypto.randomUUID();

/** Lock this tab's id; a duplicated tab gets a new one. */
export async function announceTab(): Promise<void> {
  if (!(await claimTab(tab))) {
    tab = crypto.randomUUID();
    await claimTab(tab);
  }
  sessionStorage.setItem("kineme.tab", tab);
}

function claimTab(name: string): Promise<boolean> {
  return new Promise((answer) => {
    void navigator.locks.request(`${PREFIX}.${name}`, { ifAvailable: true }, (lock) => {
      answer(lock !== null);
      return lock && new Promise(() => undefined); // held until the page closes
    });
  });
}

function storeUnsent(folder: string, recording: string, unsent: Unsent[]): void {
  const key = `${PREFIX}|${folder}|${recording}|${tab}`;
  if (unsent.length) localStorage.setItem(key, JSON.stringify(unsent));
  else localStorage.removeItem(key);
}

/** Return edits of this tab before a reload and of closed tabs; this tab now owns them. */
async function takeOverUnsent(folder: string, recording: string): Promise<Unsent[]> {
  const { held: locks = [] } = await navigator.locks.query();
  const living = new Set(locks.map((lock) => lock.name?.slice(PREFIX.length + 1)));
  living.delete(tab);
  const found = Object.keys(localStorage)
    .filter((key) => key.startsWith(`${PREFIX}|${folder}|${recording}|`))
    .filter((key) => !living.has(key.split("|").at(-1)));
  const all = found.flatMap((key) => JSON.parse(localStorage.getItem(key)!) as Unsent[]);
  found.forEach((key) => localStorage.removeItem(key));
  return all;
}
