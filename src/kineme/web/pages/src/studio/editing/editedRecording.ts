/**
 * One open recording: the table the server confirmed, and the edits on their way to it.
 *
 * The page shows what is confirmed, nothing else: the server answers within a
 * few hundredths of a second. Edits are sent one after the other, each with a
 * name of its own, by which the server knows one that is sent again. An edit
 * leaves the queue when the server has confirmed it or refused it for what it
 * is. While nobody answers, or when the table turns out to be another than the
 * one that was edited, the queue is kept, and so it is when the tab dies.
 */

import { batch, computed, effect, signal, type Signal } from "@preact/signals";
import type { Edit, Edited, Level, Recording, Segments } from "../../messages";
import { type Api, Refused, Unreachable } from "../server/api";
import { store, takeOver, type Unsent } from "./unsent";
import { inWords } from "./words";

export interface Surroundings {
  api: Api;
  folder: string;
  /** Nobody answered. */
  lost(): void;
  /** A sentence for the person, with an offer to undo where that helps. */
  tell(text: string, undo?: () => void): void;
}

export class EditedRecording {
  readonly confirmed: Signal<Recording>;
  readonly waiting = signal<Unsent[]>([]);
  /** Why the queue does not move, in a sentence; null while it does. */
  readonly held = signal<string | null>(null);
  /** Whether the server is at something slow. */
  readonly busy = computed(() => this.waiting.value.some(({ edit }) => replacesTable(edit)));

  private sending = false;
  private announced = 0;
  private readonly whenMade = new Map<string, () => void>();
  private readonly commands: (() => void)[] = [];
  private readonly stopKeeping: () => void;

  constructor(
    recording: Recording,
    private readonly around: Surroundings,
  ) {
    this.confirmed = signal(recording);
    this.stopKeeping = effect(() => store(around.folder, recording.id, this.waiting.value));
  }

  /** The recording as the server has it, with what an earlier tab could not send. */
  static async open(id: string, around: Surroundings): Promise<EditedRecording> {
    const recording = await around.api.recording(id);
    const left = await takeOver(around.folder, id);
    const edited = new EditedRecording(recording, around);
    edited.waiting.value = left;
    if (left.length) void edited.send();
    return edited;
  }

  get id(): string {
    return this.confirmed.peek().id;
  }

  /**
   * Sent when its turn comes; the promise ends when it was made, refused, or has to wait. `made`
   * is called in the moment the page has the new table.
   */
  edit(edit: Edit, made?: () => void): Promise<void> {
    const queue = this.waiting.peek();
    const base = queue.length ? null : this.confirmed.peek().revision;
    const name = crypto.randomUUID();
    if (made) this.whenMade.set(name, made);
    this.waiting.value = [...queue, { name, edit, base }];
    return this.send();
  }

  /** Does something once all edits on their way are confirmed; at once if they cannot be. */
  whenSettled(command: () => void): void {
    if (this.sending) this.commands.push(command);
    else command();
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
      finding ? found(segmentation) : "Another tab changed this table; this is how it is now.",
    );
  }

  /** Makes the held edits on the table as it is now. */
  retry(): void {
    this.held.value = null;
    this.rebase();
    void this.send();
  }

  /** Gives up the held edits. */
  drop(): void {
    this.waiting.value = [];
    this.held.value = null;
    void this.reload();
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
    if (this.sending) return this.untilSettled();
    this.sending = true;
    while (this.waiting.peek().length && this.held.peek() === null) {
      if (!(await this.sendFirst())) break;
      while (!this.waiting.peek().length && this.commands.length) this.commands.shift()!();
    }
    this.sending = false;
    for (const command of this.commands.splice(0)) command();
    const { revision } = this.confirmed.peek();
    if (this.announced > revision && !this.waiting.peek().length)
      await this.changed(this.announced);
  }

  private untilSettled(): Promise<void> {
    return new Promise((resolve) => this.whenSettled(resolve));
  }

  /** Whether the queue may go on. */
  private async sendFirst(): Promise<boolean> {
    const { edit, name, base } = this.waiting.peek()[0]!;
    const before = this.confirmed.peek();
    try {
      const revision = base ?? before.revision;
      const edited = await this.around.api.edit(this.id, { revision, edit, name });
      const made = this.whenMade.get(name);
      this.whenMade.delete(name);
      batch(() => {
        this.confirmed.value = { ...this.confirmed.peek(), ...edited };
        this.advance();
        made?.();
      });
      this.report(edit, edited);
      return true;
    } catch (error) {
      if (!(error instanceof Refused)) this.around.lost();
      else if (error.status === 400) {
        this.advance();
        this.around.tell(error.message);
        return true;
      } else if (error.status === 409) return this.reconsider(before, error.message);
      else this.held.value = error.message;
      return false;
    }
  }

  private advance(): void {
    this.waiting.value = this.waiting.peek().slice(1);
  }

  /** The first edit is one of the table as it is now. */
  private rebase(): void {
    const [first, ...rest] = this.waiting.peek();
    const base = this.confirmed.peek().revision;
    if (first) this.waiting.value = [{ ...first, base }, ...rest];
  }

  /** The server has another revision: go on if its table is the one that was edited, else wait. */
  private async reconsider(before: Recording, reason: string): Promise<boolean> {
    if (!(await this.reload())) return false;
    const now = this.confirmed.peek();
    const rows = (each: Recording) => JSON.stringify(each.segmentation.segments);
    const same = rows(now) === rows(before) && now.revision !== before.revision;
    if (same) this.rebase();
    else this.held.value = reason;
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

  private report(edit: Edit, { segmentation, notes }: Edited): void {
    const undo = replacesTable(edit) ? (): void => this.undo() : undefined;
    const said = edit.kind === "segment" ? [found(segmentation)] : [];
    const text = [...said, ...notes.filter((note) => !said.length || isLoss(note))].join(" ");
    if (text) this.around.tell(text, undo);
  }
}

/** What a segmentation found, and in what time. */
function found(table: Segments): string {
  const count = (level: Level): number =>
    table.segments.filter((row) => row.level === level && row.kind === "activity").length;
  const seconds = Object.values(table.timings).reduce((sum, each) => sum + each, 0);
  return `${count("activity")} activities, ${count("primitive")} primitives, found in ${seconds.toFixed(2)} s.`;
}

function isLoss(note: string): boolean {
  return note.startsWith("not taken over");
}

/** Whether another table takes the place of the present one, which can take a while. */
function replacesTable({ kind }: Edit): boolean {
  return ["segment", "transfer", "take_labels", "restore"].includes(kind);
}
