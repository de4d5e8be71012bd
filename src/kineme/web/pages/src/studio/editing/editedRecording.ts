/**
 * One open recording: the table the server confirmed, and the edits on their way to it.
 *
 * The page shows what these edits will make of the table; the header says how many
 * are not saved. Edits are sent one after the other, each with a name of its own,
 * by which the server knows one that is sent again, and each made on what it was
 * made on, wherever that has moved: an outage is nothing but a long latency. An edit
 * leaves the queue when the server has confirmed it; one that it refuses is laid
 * aside until somebody has decided what becomes of it. While nobody answers, or when
 * the table turns out to be another than the one that was edited, the queue is kept,
 * and so it is when the tab dies.
 */

import { batch, computed, effect, signal, type Signal } from "@preact/signals";
import type { Edit, Edited, Recording, Segments } from "../../messages";
import { type Api, Refused, Unreachable } from "../server/api";
import { changedBy } from "./changes";
import { madeOn, readdressed, type IdentifiedTable } from "./identities";
import { Outlook } from "./outlook";
import { isSame, replacesTable, undoneBy } from "./story";
import { store, takeOver, type Unsent } from "./unsent";
import { foundIn, inWords, isLoss } from "./words";

/** Of no table: the server only says whether it knows the edit. */
const NO_REVISION = -1;
const MISSING = "what it was made on is not there any more";

export interface Surroundings {
  api: Api;
  folder: string;
  /** Nobody answered, or not to us. */
  lost(): void;
  /** A sentence for the person, with an offer to undo where that helps. */
  tell(text: string): void;
}

export class EditedRecording {
  readonly confirmed: Signal<Recording>;
  readonly waiting = signal<Unsent[]>([]);
  /** Edits that could not be made, until somebody decides. */
  readonly refused = signal<Unsent[]>([]);
  /** Why the queue does not move, in a sentence; null while it does. */
  readonly blocked = signal<string | null>(null);
  /** The recording as it will be once all is made that waits. */
  readonly shown = computed<Recording>(() => {
    const { segmentation, ids } = this.outlook.after(this.confirmed.value, this.pending.value);
    return { ...this.confirmed.value, segmentation, ids: [...ids] };
  });
  /** Whether the server is at something slow. */
  readonly busy = computed(() => this.waiting.value.some(({ edit }) => replacesTable(edit)));

  private readonly outlook = new Outlook();
  /** How many of those that wait are of a table that is not there any more. */
  private readonly ofAnother = signal(0);
  private readonly pending = computed(() => this.waiting.value.slice(this.ofAnother.value));
  private sending = false;
  private announced = 0;
  /** The name of an edit that is not wanted any more. */
  private cancelled = "";
  private readonly whenMade = new Map<string, () => void>();
  private readonly commands: (() => void)[] = [];
  private readonly stopKeeping: () => void;

  constructor(
    recording: Recording,
    private readonly around: Surroundings,
  ) {
    this.confirmed = signal(recording);
    this.stopKeeping = effect(() => {
      store(around.folder, recording.id, [...this.refused.value, ...this.waiting.value]);
    });
  }

  /** The recording as the server has it, with what an earlier tab could not send. */
  static async open(id: string, around: Surroundings): Promise<EditedRecording> {
    const recording = await around.api.recording(id);
    const left = await takeOver(around.folder, id);
    const edited = new EditedRecording(recording, around);
    edited.refused.value = left.filter((each) => each.refused !== undefined);
    edited.waiting.value = left.filter((each) => each.refused === undefined);
    if (edited.waiting.value.length) void edited.send();
    return edited;
  }

  get id(): string {
    return this.confirmed.peek().id;
  }

  /**
   * Shown at once where it can be, and sent when its turn comes; the promise ends when it was made,
   * refused, or has to wait. `made` is called as it is confirmed.
   */
  edit(edit: Edit, made?: () => void): Promise<void> {
    const queue = this.waiting.peek();
    const base = queue.length ? null : this.confirmed.peek().revision;
    const name = crypto.randomUUID();
    const on = madeOn(edit, tableOf(this.shown.peek()));
    if (made) this.whenMade.set(name, made);
    const one: Unsent = { name, edit, base, on };
    const shown = [...this.pending.peek(), one];
    const hopeless = this.outlook.isHopeless(this.confirmed.peek(), shown);
    this.waiting.value = [...queue, { ...one, hopeless }];
    return this.send();
  }

  /**
   * Does something once the page shows what the edits so far make: at once, unless the server is at
   * one whose result only it knows.
   */
  whenShown(command: () => void): void {
    const open = this.outlook.isOpen(this.confirmed.peek(), this.pending.peek());
    if (this.sending && open) this.commands.push(command);
    else command();
  }

  /** The promise ends when everything is confirmed, or cannot be. */
  settled(): Promise<void> {
    if (!this.sending) return Promise.resolve();
    return new Promise((resolve) => this.commands.push(resolve));
  }

  /** What the server computes is not wanted any more, nor is the edit that waits for it. */
  cancel(): void {
    const first = this.waiting.peek()[0];
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
    if (this.waiting.peek().length) await this.send();
    else await this.reload();
  }

  /** Another page changed the table to this revision, or this one did. */
  async changed(revision: number): Promise<void> {
    this.announced = revision;
    if (this.sending || this.waiting.peek().length) return;
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
    batch(() => {
      this.blocked.value = null;
      this.ofAnother.value = 0;
    });
    void this.send();
  }

  /** Gives up the held edits; those that were made since, on the table as it is, are not among them. */
  drop(): void {
    batch(() => {
      this.waiting.value = this.pending.peek();
      this.ofAnother.value = 0;
      this.blocked.value = null;
    });
    this.rebase();
    void this.resume();
  }

  /** Makes the refused edits once more, on the table as it is now. */
  retryRefused(): void {
    const again = this.refused.peek().map(({ name, edit, on = [] }): Unsent => {
      return { name, edit, on, base: null };
    });
    batch(() => {
      this.refused.value = [];
      this.waiting.value = [...this.waiting.peek(), ...again];
    });
    void this.send();
  }

  /** Gives up the refused edits. */
  dropRefused(): void {
    this.refused.value = [];
  }

  /** Whether edits wait, to be sent or decided on. */
  isOwing(): boolean {
    return this.waiting.peek().length + this.refused.peek().length > 0;
  }

  close(): void {
    this.stopKeeping();
  }

  /** What waits, in words. */
  unsent(): string[] {
    const { fps } = this.confirmed.value;
    return this.waiting.value.map(({ edit }) => inWords(edit, fps));
  }

  private async send(): Promise<void> {
    if (this.sending) return this.settled();
    this.sending = true;
    while (this.waiting.peek().length && this.blocked.peek() === null) {
      if (!(await this.sendFirst())) break;
      while (!this.waiting.peek().length && this.commands.length) this.commands.shift()!();
    }
    this.sending = false;
    for (const command of this.commands.splice(0)) command();
    const { revision } = this.confirmed.peek();
    if (this.announced > revision && !this.waiting.peek().length)
      await this.changed(this.announced);
  }

  /** Whether the queue may go on. */
  private async sendFirst(): Promise<boolean> {
    const first = this.waiting.peek()[0]!;
    const { name, base, on = [] } = first;
    const before = this.confirmed.peek();
    // Who is in a table that is still to be found, the server knows that waits for it.
    const edit = before.finding ? first.edit : readdressed(first.edit, on, tableOf(before));
    try {
      const revision = edit ? (base ?? before.revision) : NO_REVISION;
      const sent = { revision, edit: edit ?? first.edit, name, brief: true };
      const edited = await this.around.api.edit(this.id, sent);
      const now = await this.after(edited);
      const made = this.whenMade.get(name);
      this.whenMade.delete(name);
      batch(() => {
        this.confirmed.value = this.outlook.confirm(first, this.confirmed.peek(), now);
        this.advance();
        made?.();
      });
      this.report(first.edit, now.segmentation, edited.notes);
      return true;
    } catch (error) {
      if (!(error instanceof Refused) || error.status === 403) this.around.lost();
      else if (error.status === 400) return this.layAside(first, error.message);
      else if (error.status === 409 && !edit) return this.layAside(first, MISSING);
      else if (error.status === 409) return this.reconsider(before, error.message);
      else this.hold(error.message);
      return false;
    }
  }

  /** The recording once an edit is made; asked for where the answer is of another table than ours. */
  private async after({ change, ...edited }: Edited): Promise<Recording> {
    const before = this.confirmed.peek();
    const all = edited.segmentation && { segmentation: edited.segmentation, ids: edited.ids };
    const table = change?.of === before.revision ? changedBy(change, tableOf(before)) : all;
    if (!table) return this.around.api.recording(this.id);
    const { revision, can_undo, can_redo, saved } = edited;
    const now = { segmentation: table.segmentation, ids: [...table.ids], finding: false };
    return { ...before, ...now, revision, can_undo, can_redo, saved };
  }

  private advance(): void {
    this.waiting.value = this.waiting.peek().slice(1);
  }

  /**
   * An edit that cannot be made is kept until somebody decides. One that was never shown as made is
   * only told of, and undo of one is no edit at all.
   */
  private layAside(first: Unsent, reason: string): boolean {
    const rest = this.waiting.peek().slice(1);
    const back = undoneBy(rest.map(({ edit }) => edit));
    const isStep = first.edit.kind === "undo" || first.edit.kind === "redo";
    batch(() => {
      this.waiting.value = isStep ? rest : rest.filter((_, i) => i !== back);
      const isDone = isStep || back >= 0 || first.hopeless || first.name === this.cancelled;
      if (isDone) this.around.tell(reason);
      else this.refused.value = [...this.refused.peek(), { ...first, refused: reason }];
    });
    this.whenMade.delete(first.name);
    return true;
  }

  /** The first edit is one of the table as it is now. */
  private rebase(): void {
    const [first, ...rest] = this.waiting.peek();
    const base = this.confirmed.peek().revision;
    if (first) this.waiting.value = [{ ...first, base }, ...rest];
  }

  /** All that waits is of another table than the one that is there, or cannot be saved now. */
  private hold(reason: string): void {
    batch(() => {
      this.ofAnother.value = this.waiting.peek().length;
      this.blocked.value = reason;
    });
  }

  /** The server has another revision: go on if its table is the one that was edited, else wait. */
  private async reconsider(before: Recording, reason: string): Promise<boolean> {
    if (!(await this.reload())) return false;
    const now = this.confirmed.peek();
    const isOther = now.revision !== before.revision;
    const same = isOther && isSame(now.segmentation.segments, before.segmentation.segments);
    if (same) this.rebase();
    else this.hold(reason);
    return same;
  }

  private async reload(): Promise<boolean> {
    try {
      const before = this.confirmed.peek();
      const now = await this.around.api.recording(this.id);
      const since = this.confirmed.peek(); // an edit may have been confirmed on the way
      if (since === before || now.revision >= since.revision) this.confirmed.value = now;
      return true;
    } catch (error) {
      if (error instanceof Unreachable) this.around.lost();
      else this.around.tell((error as Error).message);
      return false;
    }
  }

  private report(edit: Edit, segmentation: Segments, notes: string[]): void {
    const found = edit.kind === "segment" ? [foundIn(segmentation)] : [];
    const text = [...found, ...notes.filter((note) => !found.length || isLoss(note))].join(" ");
    if (text) this.around.tell(text);
  }
}

function tableOf({ segmentation, ids = [] }: Recording): IdentifiedTable {
  return { segmentation, ids };
}
