/** Go through the segments to review and mark them. */
import { computed, signal } from "@preact/signals";
import type { Segment, Segments } from "../../messages";
import type { Editor } from "../editing/editor";
import { Folder, NameOffer } from "../folder/folder";
import { findRow, findSegmentAt, getLane, getSegmentKey } from "../../segments";
import type { Session } from "../session";
import { listDoubts, type Doubt } from "../../confidence";
import { getDoubts } from "../folder/briefTables";

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
    const key = target && getSegmentKey(target);
    return this.doubts.value.find(({ segment }) => getSegmentKey(segment) === key) ?? null;
  });
  /** Keys of segments that were skipped; these come last. */
  private readonly passed = new Set<string>();

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
    // Without an open recording, review the folder.
    const hasSeveral = (session.state.value?.recordings.length ?? 0) > 1;
    if (!session.store.recording.value && hasSeveral) return this.setEverywhere(true);
    const { doubts, present } = this;
    // Skip the current segment. If all are skipped, start again with those still in doubt.
    if (present.value) this.passed.add(getSegmentKey(present.value.segment));
    let next = doubts.value.find(({ segment }) => !this.passed.has(getSegmentKey(segment)));
    if (!next) {
      await session.edited.value?.waitUntilSent(); // the segment just checked is no longer in doubt
      this.passed.clear();
      next = doubts.value.find((doubt) => doubt !== present.value) ?? doubts.value[0];
    }
    if (next) session.store.showSegment(next.segment);
    else session.notifications.tell("Every segment of this recording is checked.");
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

const PREFETCH_COUNT = 2; // recordings that the server opens in advance
const PREFETCH_PLACES = 12; // places that they are taken from

/** A segment to review, in a recording of the folder. */
export interface Place {
  id: string;
  recording: string;
  doubt: Doubt;
}

export class FolderQueue {
  /** All unchecked places, lowest confidence first. */
  readonly places = computed<Place[]>(() =>
    this.folder.members.value
      .flatMap(({ listing, table }) => (table ? listPlaces(listing.id, listing.name, table) : []))
      .sort((a, b) => (a.doubt.confidence.value ?? 2) - (b.doubt.confidence.value ?? 2)),
  );
  /** The current place, as it was before any edit. */
  readonly current = signal<Place | null>(null);
  /** Keys of places that were skipped; these come last. */
  private readonly passed = new Set<string>();
  private readonly prepared = new Set<string>();

  constructor(private readonly folder: Folder) {}

  /** Go to the place of lowest confidence that was not skipped. */
  async goToNext(): Promise<void> {
    const { folder } = this;
    if (!folder.isReady.value) await folder.refresh();
    if (!this.places.value.length && folder.unsegmented.value.length) await folder.segmentAll();
    this.passPresent();
    if (!this.listUpcoming().length) {
      // The segment just checked is no longer in doubt.
      await folder.session.edited.value?.waitUntilSent();
      this.passed.clear();
    }
    const [next, ...after] = this.listUpcoming();
    if (next) {
      await this.goTo(next);
      this.prepare(after.slice(0, PREFETCH_PLACES));
    } else {
      this.current.value = null;
      folder.session.notifications.tell("Every segment of every recording is checked.");
    }
  }

  /** Open the recording of a place and show it. */
  async goTo(place: Place): Promise<void> {
    const { session } = this.folder;
    this.current.value = place;
    if (session.store.recording.value?.id === place.id) this.show(place);
    else await session.open(place.id, { shown: () => this.show(place) });
  }

  private show(place: Place): void {
    const { store } = this.folder.session;
    const table = store.recording.value;
    // Another place was chosen meanwhile.
    if (table?.id !== place.id || this.current.value !== place) return;
    store.showSegment(findPresent(table.segmentation, place.doubt.segment));
  }

  /** Skip the current place, also if an edit moved its start. */
  private passPresent(): void {
    const { current } = this;
    const { recording, target } = this.folder.session.store;
    if (!current.value) return;
    const { id, doubt } = current.value;
    this.passed.add(getPlaceKey(id, doubt.segment));
    if (target.value && recording.value?.id === id) this.passed.add(getPlaceKey(id, target.value));
  }

  /** Return the places that were not skipped. */
  private listUpcoming(): Place[] {
    return this.places.value.filter(
      ({ id, doubt }) => !this.passed.has(getPlaceKey(id, doubt.segment)),
    );
  }

  /** Let the server open the next recordings. */
  private prepare(places: readonly Place[]): void {
    const { session } = this.folder;
    const present = session.recordings.value.map(({ id }) => id);
    const ids = [...new Set(places.map(({ id }) => id))].filter((id) => !present.includes(id));
    for (const id of ids.slice(0, PREFETCH_COUNT)) {
      if (this.prepared.has(id)) continue;
      this.prepared.add(id);
      if (this.prepared.size > PREFETCH_COUNT * 3) this.prepared.delete([...this.prepared][0]!);
      session.api.loadRecording(id).catch(() => undefined); // opening it will report the problem
    }
  }
}

const kept = new WeakMap<Segments, Place[]>();

function listPlaces(id: string, recording: string, table: Segments): Place[] {
  const found = kept.get(table) ?? getDoubts(table).map((doubt) => ({ id, recording, doubt }));
  kept.set(table, found);
  return found;
}

function getPlaceKey(id: string, segment: Segment): string {
  return `${id} ${getSegmentKey(segment)}`;
}

/** Return the current segment that contains the start of another one. */
function findPresent(table: Segments, { level, start_frame }: Segment): Segment {
  return findSegmentAt(getLane(table, level), start_frame) ?? table.segments[0]!;
}
