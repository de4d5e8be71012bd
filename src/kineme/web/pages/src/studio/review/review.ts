/** The way through what should be looked at: the next one, and the marks on what was. */
import { computed, signal } from "@preact/signals";
import type { Segment } from "../../messages";
import type { Editor } from "../editing/editor";
import { Folder } from "../folder/folder";
import { FolderQueue } from "../folder/folderQueue";
import { NameOffer } from "../folder/offer";
import { findRow } from "../../segments";
import type { Session } from "../session";
import { doubtsOf, type Doubt } from "./doubts";

export class Review {
  /** Whether J goes through all recordings of the folder. */
  readonly everywhere = signal(false);
  readonly folder: Folder;
  readonly queue: FolderQueue;
  readonly offer: NameOffer;
  readonly doubts = computed<Doubt[]>(() => {
    const table = this.session.store.table.value;
    return table ? doubtsOf(table) : [];
  });
  /** What is looked at, and why; null once the playhead has left it. */
  readonly present = computed(() => {
    const target = this.editor.segment.value;
    return this.doubts.value.find(({ segment }) => same(segment, target)) ?? null;
  });
  /** Those that were passed over without a mark come last. */
  private readonly passed = signal(new Set<string>());

  constructor(
    private readonly session: Session,
    private readonly editor: Editor,
  ) {
    this.folder = new Folder(session);
    this.queue = new FolderQueue(this.folder);
    this.offer = new NameOffer(this.folder);
  }

  /** Goes through all recordings from now on, the least sure place of them first; or no more. */
  async goEverywhere(everywhere: boolean): Promise<void> {
    this.everywhere.value = everywhere;
    if (everywhere) await this.queue.next();
    else this.queue.looking.value = null;
  }

  /** Goes to the segment of lowest confidence that has not been looked at. */
  async next(): Promise<void> {
    const { everywhere, session } = this;
    if (everywhere.value) return this.queue.next();
    const several = (session.state.value?.recordings.length ?? 0) > 1;
    if (!session.store.recording.value && several) return this.goEverywhere(true);
    const { doubts, present } = this;
    if (present.value) this.passed.value.add(keyOf(present.value.segment));
    let next = doubts.value.find(({ segment }) => !this.passed.value.has(keyOf(segment)));
    if (!next) {
      await session.edited.value?.settled(); // what was just checked is none any more
      this.passed.value.clear();
      next = doubts.value.find((doubt) => doubt !== present.value) ?? doubts.value[0];
    }
    if (next) this.go(next);
    else this.session.bulletin.tell("Every segment of this recording is checked.");
  }

  go({ segment }: Doubt): void {
    this.session.store.lookAt(segment);
  }

  /** Marks the segment at the playhead as checked, and goes on. */
  checkAndGoOn(): void {
    if (!this.editor.segment.value || !this.session.edited.value?.takesEdits()) return;
    this.editor.atPlayhead((segment) => this.editor.check([segment], true));
    void this.next();
  }

  /** Marks the segment at the playhead, or takes the mark away. */
  toggle(): void {
    this.editor.atPlayhead((segment) => this.editor.check([segment], !this.isChecked(segment)));
  }

  isChecked(segment: Segment): boolean {
    const table = this.session.store.table.value;
    return Boolean(table && findRow(table, segment)?.checked);
  }
}

/** Where it starts; an edit of its end makes it no other. */
export function keyOf({ level, start_frame }: Segment): string {
  return `${level} ${start_frame}`;
}

function same(a: Segment, b: Segment | undefined): boolean {
  return b !== undefined && keyOf(a) === keyOf(b);
}
