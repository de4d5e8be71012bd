/**
 * One open recording: the table the server confirmed, and the edits on their way to it.
 *
 * Edits are shown at once and sent one after the other. An edit leaves the
 * queue when the server has confirmed it or refused it for what it is. While
 * nobody answers, or when the table turns out to be another than the one that
 * was edited, the queue is kept, and so it is when the tab dies.
 */

import { batch, computed, effect, signal } from "@preact/signals";
import type { Edit, Edited, Level, Recording, Segments } from "../../messages";
import { type Api, Refused, Unreachable } from "../server/api";
import { fingerprint, inWords, isDone, preview } from "./preview";
import { store, takeOver } from "./unsent";

/** An edit in the queue; `tried`: it was sent, and may have arrived. */
interface Waiting {
  edit: Edit;
  tried: boolean;
}

export interface Surroundings {
  api: Api;
  folder: string;
  /** Nobody answered. */
  lost(): void;
  /** A sentence for the person, with an offer to undo where that helps. */
  tell(text: string, undo?: () => void): void;
}

export class EditedRecording {
  readonly confirmed;
  readonly waiting = signal<Waiting[]>([]);
  /** Why the queue does not move, in a sentence; null while it does. */
  readonly held = signal<string | null>(null);
  readonly shown = computed(() => ({
    ...this.confirmed.value,
    segmentation: preview(
      this.confirmed.value.segmentation,
      this.waiting.value.map((waiting) => waiting.edit),
    ),
  }));
  /** Whether the server is at something slow. */
  readonly busy = computed(() => this.waiting.value.some(({ edit }) => isSlow(edit)));

  private sending = false;
  private announced = 0;
  private readonly stopKeeping: () => void;

  constructor(
    recording: Recording,
    private readonly around: Surroundings,
  ) {
    this.confirmed = signal(recording);
    this.stopKeeping = effect(() =>
      store(around.folder, recording.id, {
        base: fingerprint(this.confirmed.value.segmentation),
        edits: this.waiting.value.map((waiting) => waiting.edit),
      }),
    );
  }

  /** The recording as the server has it, with what an earlier tab could not send. */
  static async open(id: string, around: Surroundings): Promise<EditedRecording> {
    const recording = await around.api.recording(id);
    const left = await takeOver(around.folder, id);
    const edited = new EditedRecording(recording, around);
    if (left) {
      edited.waiting.value = left.edits.map((edit) => ({ edit, tried: true }));
      edited.settle(left.base);
      void edited.send();
    }
    return edited;
  }

  get id(): string {
    return this.confirmed.peek().id;
  }

  /** Shown at once, sent when its turn comes; the latest of several segmentations is enough. */
  edit(edit: Edit): void {
    const queue = this.waiting.peek();
    const last = queue.at(-1);
    const replaces = edit.kind === "segment" && last?.edit.kind === "segment" && !last.tried;
    this.waiting.value = [...(replaces ? queue.slice(0, -1) : queue), { edit, tried: false }];
    void this.send();
  }

  /** Takes back the last edit: from the queue if it never left, else from the table. */
  undo(): void {
    const queue = this.waiting.peek();
    const last = queue.at(-1);
    const inQueue = last && !last.tried && last.edit.kind !== "undo" && last.edit.kind !== "redo";
    if (inQueue) this.waiting.value = queue.slice(0, -1);
    else this.edit({ kind: "undo" });
  }

  /** The server answers again: find out what it has, then go on. */
  async resume(): Promise<void> {
    if (this.sending) return;
    this.announced = 0; // a new server counts anew
    const base = fingerprint(this.confirmed.peek().segmentation);
    if (await this.reload()) {
      this.settle(base);
      await this.send();
    }
  }

  /** Another page changed the table to this revision, or this one did. */
  async changed(revision: number): Promise<void> {
    this.announced = revision;
    if (this.sending || this.waiting.peek().length) return;
    if (revision === this.confirmed.peek().revision) return;
    if (await this.reload())
      this.around.tell("Another tab changed this table; this is how it is now.");
  }

  /** Makes the held edits on the table as it is now. */
  retry(): void {
    this.held.value = null;
    void this.resume();
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
    if (this.sending) return;
    this.sending = true;
    while (this.waiting.peek().length && this.held.peek() === null) {
      if (!(await this.sendFirst())) break;
    }
    this.sending = false;
    const { revision } = this.confirmed.peek();
    if (this.announced > revision && !this.waiting.peek().length)
      await this.changed(this.announced);
  }

  /** Whether the queue may go on. */
  private async sendFirst(): Promise<boolean> {
    const [first, ...rest] = this.waiting.peek();
    const { edit } = first!;
    this.waiting.value = [{ edit, tried: true }, ...rest];
    const before = this.confirmed.peek();
    try {
      const edited = await this.around.api.edit(this.id, { revision: before.revision, edit });
      batch(() => {
        this.confirmed.value = { ...this.confirmed.peek(), ...edited };
        this.advance();
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

  /** The server has another revision: go on if its table is the one that was edited, else wait. */
  private async reconsider(before: Recording, reason: string): Promise<boolean> {
    const base = fingerprint(before.segmentation);
    if (!(await this.reload())) return false;
    const now = this.confirmed.peek();
    const same = fingerprint(now.segmentation) === base && now.revision !== before.revision;
    if (!same) this.held.value = reason;
    return same;
  }

  /** After a break: was the first edit carried out, and is the table still the one it was made on? */
  private settle(base: string): void {
    const queue = this.waiting.peek();
    const table = this.confirmed.peek().segmentation;
    if (!queue.length || fingerprint(table) === base) return;
    if (queue[0]!.tried && isDone(queue[0]!.edit, table)) this.waiting.value = queue.slice(1);
    else this.held.value = "the table was changed elsewhere while these edits waited";
  }

  private async reload(): Promise<boolean> {
    try {
      this.confirmed.value = await this.around.api.recording(this.id);
      return true;
    } catch (error) {
      if (error instanceof Unreachable) this.around.lost();
      else this.around.tell((error as Error).message);
      return false;
    }
  }

  private report(edit: Edit, edited: Edited): void {
    const undo = isSlow(edit) ? (): void => this.undo() : undefined;
    const text = edit.kind === "segment" ? found(edited.segmentation) : edited.notes.join(" ");
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

function isSlow(edit: Edit): boolean {
  return edit.kind === "segment" || edit.kind === "transfer";
}
