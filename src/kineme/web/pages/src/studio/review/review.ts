/** Go through the segments to review and mark them. */
import { computed, signal } from "@preact/signals";
import type { Segment } from "../../messages";
import type { Editor } from "../editing/editor";
import { Folder, NameOffer } from "../folder/folder";
import { FolderQueue } from "../folder/folderQueue";
import { findRow, getSegmentKey } from "../../segments";
import type { Session } from "../session";
import { listDoubts, type Doubt } from "../../confidence";

export class Review {
  /** Whether the review covers all recordings of the folder. */
  readonly everywhere = signal(false);
  readonly folder: Folder;
  readonly queue: FolderQueue;
  readonly offer: NameOffer;
  readonly doubts = computed<Doubt[]>(() => {
    const table = this.session.store.table.value;
    return table ? listDoubts(table) : [];
  });
  /** The current doubt; null once the playhead has left it. */
  readonly present = computed(() => {
    const target = this.editor.segment.value;
    return this.doubts.value.find(({ segment }) => isSame(segment, target)) ?? null;
  });
  /** Keys of places that were skipped; these come last. */
  private readonly passed = signal(new Set<string>());

  constructor(
    private readonly session: Session,
    private readonly editor: Editor,
  ) {
    this.folder = new Folder(session);
    this.queue = new FolderQueue(this.folder);
    this.offer = new NameOffer(this.folder);
  }

  /** Start or stop reviewing all recordings. */
  async setEverywhere(everywhere: boolean): Promise<void> {
    this.everywhere.value = everywhere;
    if (everywhere) await this.queue.goToNext();
    else this.queue.current.value = null;
  }

  /** Go to the segment of lowest confidence that was not skipped. */
  async goToNext(): Promise<void> {
    const { everywhere, session } = this;
    if (everywhere.value) return this.queue.goToNext();
    const several = (session.state.value?.recordings.length ?? 0) > 1;
    if (!session.store.recording.value && several) return this.setEverywhere(true);
    const { doubts, present } = this;
    if (present.value) this.passed.value.add(getSegmentKey(present.value.segment));
    let next = doubts.value.find(({ segment }) => !this.passed.value.has(getSegmentKey(segment)));
    if (!next) {
      await session.edited.value?.waitUntilSent(); // the segment just checked is no longer in doubt
      this.passed.value.clear();
      next = doubts.value.find((doubt) => doubt !== present.value) ?? doubts.value[0];
    }
    if (next) this.goTo(next);
    else this.session.notifications.tell("Every segment of this recording is checked.");
  }

  goTo({ segment }: Doubt): void {
    this.session.store.showSegment(segment);
  }

  /** Mark the current segment as checked and go to the next. */
  checkAndGoOn(): void {
    if (!this.editor.segment.value || !this.session.edited.value?.acceptsEdits()) return;
    this.editor.runAtPlayhead((segment) => this.editor.setChecked([segment], true));
    void this.goToNext();
  }

  /** Mark the current segment as checked or unchecked. */
  toggleChecked(): void {
    this.editor.runAtPlayhead((segment) =>
      this.editor.setChecked([segment], !this.isChecked(segment)),
    );
  }

  isChecked(segment: Segment): boolean {
    const table = this.session.store.table.value;
    return Boolean(table && findRow(table, segment)?.checked);
  }
}

function isSame(a: Segment, b: Segment | undefined): boolean {
  return b !== undefined && getSegmentKey(a) === getSegmentKey(b);
}
