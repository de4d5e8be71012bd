/** Review the segments of all recordings, lowest confidence first. */
import { computed, signal } from "@preact/signals";
import type { Segment, Segments } from "../../messages";
import { findIndexAt, getSegmentKey } from "../../segments";
import type { Doubt } from "../../confidence";
import { getDoubts } from "./briefTables";
import type { Folder } from "./folder";

const PREFETCH_COUNT = 2; // recordings that the server opens in advance

/** A segment to review, in a recording of the folder. */
export interface Place {
  id: string;
  recording: string;
  doubt: Doubt;
}

interface Key {
  id: string;
  doubt: Pick<Doubt, "segment">;
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
  private readonly passed = signal(new Set<string>());
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
      this.passed.value.clear();
    }
    const [next, ...after] = this.listUpcoming();
    if (next) {
      await this.goTo(next);
      this.prepare(after);
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
    this.passed.value.add(getPlaceKey(current.value));
    if (target.value && recording.value?.id === current.value.id)
      this.passed.value.add(
        getPlaceKey({ id: current.value.id, doubt: { segment: target.value } }),
      );
  }

  /** Return the next places that were not skipped. */
  private listUpcoming(): Place[] {
    const { value: passed } = this.passed;
    return takeFirst(this.places.value, (each) => !passed.has(getPlaceKey(each)));
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
  let found = kept.get(table);
  if (!found) {
    found = getDoubts(table).map((doubt) => ({ id, recording, doubt }));
    kept.set(table, found);
  }
  return found;
}

/** Return the first few places for which `holds` is true. */
function takeFirst(places: readonly Place[], holds: (place: Place) => boolean): Place[] {
  const found: Place[] = [];
  for (const place of places) {
    if (holds(place)) found.push(place);
    if (found.length > 12) break;
  }
  return found;
}

/** Return a key by level and start, which stays when the end changes. */
function getPlaceKey({ id, doubt: { segment } }: Key): string {
  return `${id} ${getSegmentKey(segment)}`;
}

/** Return the current segment that starts there, else the one that contains the frame. */
function findPresent({ segments }: Segments, { level, start_frame }: Segment): Segment {
  const lane = segments.filter((each) => each.level === level);
  return lane[Math.max(findIndexAt(lane, start_frame), 0)] ?? segments[0]!;
}
