/**
 * One open recording: the table that the server has, and the edits on their way there.
 *
 * Edits are sent one after the other, and the page shows the table of the last answer. Each
 * has a name, by which the server knows one that is sent again, and follows the segments that
 * it names wherever the edits before it move them. An edit leaves the queue
 * when the server has answered it. While nobody answers, the queue is kept, also when the tab
 * dies, and takes nothing more; so it is when the table turns out to be another than the one
 * that was edited, until somebody has decided what becomes of the edits.
 */

import { batch, computed, effect, signal, type Signal } from "@preact/signals";
import type { Edit, Edited, Recording, Segments } from "../../messages";
import { type Api, Refused, Unreachable } from "../server/api";
import { applyChange } from "./changes";
import { follow } from "./follow";
import { store, takeOver, type Unsent } from "./unsent";
import { foundIn, inWords, isLoss, replacesTable } from "./words";

const MISSING = "what it was made on is not there any more";
const AWAY = "Not done: the studio’s server does not answer.";
const UNDECIDED = "Not done: first choose what becomes of the edits above.";

/** What waits for its turn: an edit, or a command that looks at the table of the edits before it. */
type Turn = Unsent | (() => void);

export interface Surroundings {
  api: Api;
  folder: string;
  /** Whether nobody has answered since it was last tried. */
  isAway(): boolean;
  /** Nobody answered, or not to us. */
  lost(): void;
  /** A sentence for the person, in passing. */
  tell(text: string, refused?: boolean): void;
  /** A sentence that stays until it is read. */
  warn(text: string): void;
}

export class EditedRecording {
  readonly confirmed: Signal<Recording>;
  /** Why the queue does not move, in a sentence; null while it does. */
  readonly blocked = signal<string | null>(null);
  /** Whether the server is at something slow. */
  readonly busy = computed(() => this.edits.value.some(({ edit }) => replacesTable(edit)));

  private readonly queue = signal<Turn[]>([]);
  private readonly edits = computed(() => this.queue.value.filter(isEdit));
  private sending: Promise<void> | null = null;
  private announced = 0;
  /** The name of an edit that is not wanted any more. */
  private cancelled = "";
  private readonly whenMade = new Map<string, () => void>();
  private readonly stopKeeping: () => void;

  constructor(
    recording: Recording,
    private readonly around: Surroundings,
  ) {
    this.confirmed = signal(recording);
    this.stopKeeping = effect(() => store(around.folder, recording.id, this.edits.value));
  }

  /** The recording as the server has it, with what an earlier tab could not send. */
  static async open(id: string, around: Surroundings): Promise<EditedRecording> {
    const recording = await around.api.recording(id);
    const left = await takeOver(around.folder, id);
    const edited = new EditedRecording(recording, around);
    edited.queue.value = left;
    if (left.length) void edited.send();
    return edited;
  }

  get id(): string {
    return this.confirmed.peek().id;
  }

  /** Whether edits can be made now; where they cannot, says why. */
  takesEdits(): boolean {
    const why = this.around.isAway() ? AWAY : this.blocked.peek() === null ? "" : UNDECIDED;
    if (why) this.around.tell(why, true);
    if (why) this.showAnew();
    return !why;
  }

  /**
   * Sent when its turn comes; the promise ends when it was made, refused, or has to wait. `made` is
   * called as the table is shown that it made. An edit that somebody began on an earlier `table`
   * follows the segments that it names from there.
   */
  edit(wanted: Edit, made?: () => void, table?: Segments): Promise<void> {
    if (!this.takesEdits()) return Promise.resolve();
    const { segmentation, fps } = this.confirmed.peek();
    const edit = table ? follow(wanted, table, segmentation) : wanted;
    if (!edit) {
      this.around.warn(`Not made: ${inWords(wanted, fps)} (${MISSING}).`);
      return Promise.resolve();
    }
    const queue = this.queue.peek();
    const name = crypto.randomUUID();
    if (made) this.whenMade.set(name, made);
    const base = queue.length ? null : this.confirmed.peek().revision;
    this.queue.value = [...queue, { name, edit, base }];
    return this.send();
  }

  /** Does something once the page shows what the edits so far make: at once, if none waits. */
  whenShown(command: () => void): void {
    if (!this.sending) command();
    else if (this.takesEdits()) this.queue.value = [...this.queue.peek(), command];
  }

  /** The promise ends when everything is confirmed, or cannot be. */
  settled(): Promise<void> {
    return this.sending ?? Promise.resolve();
  }

  /** What the server computes is not wanted any more, nor is the edit that waits for it. */
  cancel(): void {
    const first = this.edits.peek()[0];
    if (first && replacesTable(first.edit)) this.cancelled = first.name;
    void this.around.api.cancel(this.id).catch(() => undefined); // then it is made
  }

  /** Takes back the last edit. */
  undo(): void {
    void this.edit({ kind: "undo" });
  }

  /** The server answers again: what it has is shown, what waits is sent. */
  async resume(): Promise<void> {
    if (this.sending) return;
    this.announced = 0;
    if (this.isOwing()) await this.send();
    else await this.reload();
  }

  /** Another page changed the table to this revision, or this one did. */
  async changed(revision: number): Promise<void> {
    this.announced = revision;
    if (this.sending || this.isOwing()) return;
    if (revision === this.confirmed.peek().revision) return;
    const { finding } = this.confirmed.peek();
    if (!(await this.reload())) return;
    const { segmentation, finding: still, saved } = this.confirmed.peek();
    if (still || (finding && saved)) return; // it was saved, and only read late
    this.around.tell(
      finding ? foundIn(segmentation) : "Another tab changed this table; this is how it is now.",
    );
  }

  /** Makes the held edits on the table as it is now. */
  retry(): void {
    this.rebase();
    this.blocked.value = null;
    void this.send();
  }

  /** Gives up the held edits. */
  drop(): void {
    batch(() => {
      this.queue.value = [];
      this.blocked.value = null;
    });
    void this.resume();
  }

  /** Whether edits wait, to be sent or decided on. */
  isOwing(): boolean {
    return this.queue.peek().length > 0;
  }

  close(): void {
    this.stopKeeping();
  }

  /** What waits, in words. */
  unsent(): string[] {
    const { fps } = this.confirmed.value;
    return this.queue.value.map((each) =>
      isEdit(each) ? inWords(each.edit, fps) : "a key pressed since",
    );
  }

  private send(): Promise<void> {
    return (this.sending ??= this.sendAll());
  }

  private async sendAll(): Promise<void> {
    await Promise.resolve(); // `sending` is set by then
    while (this.isOwing() && this.blocked.peek() === null) if (!(await this.sendFirst())) break;
    this.sending = null;
    if (this.announced > this.confirmed.peek().revision) await this.changed(this.announced);
  }

  /** Whether the queue may go on. */
  private async sendFirst(): Promise<boolean> {
    const [first, ...rest] = this.queue.peek();
    if (!isEdit(first!)) {
      batch(() => {
        this.queue.value = []; // its edits come before the rest
        first?.();
        this.queue.value = [...this.queue.peek(), ...rest];
      });
      return true;
    }
    if (first.isGone) return this.refuse(first, MISSING);
    const { name, edit, base } = first;
    const before = this.confirmed.peek();
    try {
      const revision = base ?? before.revision;
      const edited = await this.around.api.edit(this.id, { revision, edit, name });
      const now = await this.after(edited);
      batch(() => {
        this.queue.value = this.queue.peek().slice(1);
        this.show(now);
        this.whenMade.get(name)?.();
      });
      this.whenMade.delete(name);
      this.report(edit, now.segmentation, edited.notes);
      return true;
    } catch (error) {
      if (!(error instanceof Refused) || error.status === 403) this.around.lost();
      else if (error.status === 400) return this.refuse(first, error.message);
      else if (error.status === 409) return this.reconsider(before, error.message);
      else this.blocked.value = error.message;
      return false;
    }
  }

  /** The recording once an edit is made; asked for where the answer is of another table than ours. */
  private async after({ change, segmentation, ...edited }: Edited): Promise<Recording> {
    const before = this.confirmed.peek();
    const isOurs = change?.of === before.revision;
    const table = isOurs ? applyChange(before.segmentation, change) : segmentation;
    if (!table) return this.around.api.recording(this.id);
    const { revision, can_undo, can_redo, saved } = edited;
    const now = { revision, can_undo, can_redo, saved, finding: false };
    return { ...before, ...now, segmentation: table };
  }

  /** Shows the recording as it is now; edits that wait follow the segments that they name. */
  private show(now: Recording): void {
    const { segmentation: before } = this.confirmed.peek();
    batch(() => {
      this.confirmed.value = now;
      this.queue.value = this.queue.peek().map((turn) => {
        if (!isEdit(turn) || turn.isGone) return turn;
        const edit = follow(turn.edit, before, now.segmentation);
        return edit ? { ...turn, edit } : { ...turn, isGone: true };
      });
    });
  }

  /** An edit that cannot be made is none; undo of it, which may wait behind it, is none, either. */
  private refuse({ name, edit }: Unsent, reason: string): boolean {
    const rest = this.queue.peek().slice(1);
    const isStep = edit.kind === "undo" || edit.kind === "redo";
    const back = isStep ? -1 : undoneBy(rest);
    this.queue.value = rest.filter((_, i) => i !== back);
    this.whenMade.delete(name);
    if (isStep || back >= 0 || name === this.cancelled) this.around.tell(reason, true);
    else this.around.warn(`Not made: ${inWords(edit, this.confirmed.peek().fps)} (${reason}).`);
    this.showAnew();
    return true;
  }

  /** Fields and boxes show the table as it is, and not what was asked for in vain. */
  private showAnew(): void {
    const now = this.confirmed.peek();
    this.confirmed.value = { ...now, segmentation: { ...now.segmentation } };
  }

  /** The first edit is one of the table as it is now. */
  private rebase(): void {
    const [first, ...rest] = this.queue.peek();
    const base = this.confirmed.peek().revision;
    if (first && isEdit(first)) this.queue.value = [{ ...first, base }, ...rest];
  }

  /** The server has another revision: go on if its table is the one that was edited, else wait. */
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
      const now = await this.around.api.recording(this.id);
      const since = this.confirmed.peek(); // an edit may have been confirmed on the way
      if (since === before || now.revision >= since.revision) this.show(now);
      return true;
    } catch (error) {
      if (error instanceof Unreachable) this.around.lost();
      else this.around.tell((error as Error).message, true);
      return false;
    }
  }

  private report(edit: Edit, segmentation: Segments, notes: string[]): void {
    const found = edit.kind === "segment" ? [foundIn(segmentation)] : [];
    const text = [...found, ...notes.filter((note) => !found.length || isLoss(note))].join(" ");
    if (text) this.around.tell(text);
  }
}

function isEdit(turn: Turn): turn is Unsent {
  return typeof turn !== "function";
}

/** Which of the edits after an edit takes it back; -1: none. */
function undoneBy(later: readonly Turn[]): number {
  let made = 0; // since then, and not taken back
  for (const [i, each] of later.entries()) {
    const isUndo = isEdit(each) && each.edit.kind === "undo";
    if (isUndo && made === 0) return i;
    made += isUndo ? -1 : 1;
  }
  return -1;
}
