/** The way through the least sure places of all recordings of the folder. */
import { computed, signal } from "@preact/signals";
import type { Segment, Segments } from "../../messages";
import { indexAt } from "../../segments";
import type { Doubt } from "../review/doubts";
import { queueOf } from "./briefTables";
import type { Folder } from "./folder";

const AHEAD = 2; // recordings that the server opens before they are gone to

/** A place to look at, in a recording of the folder. */
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
  /** All places that are not checked, those of lowest confidence first. */
  readonly places = computed<Place[]>(() =>
    this.folder.members.value
      .flatMap(({ listing, table }) => (table ? placesOf(listing.id, listing.name, table) : []))
      .sort((a, b) => (a.doubt.value ?? 2) - (b.doubt.value ?? 2)),
  );
  /** What is looked at, as it was when it was gone to: an edit does not change why. */
  readonly looking = signal<Place | null>(null);
  /** Those that were passed over without a mark come last. */
  private readonly passed = signal(new Set<string>());
  private readonly readied = new Set<string>();

  constructor(private readonly folder: Folder) {}

  /** Goes to the place of lowest confidence that has not been looked at. */
  async next(): Promise<void> {
    const { folder } = this;
    if (!folder.ready.value) await folder.refresh();
    if (!this.places.value.length && folder.without.value.length) await folder.find();
    this.passPresent();
    if (!this.upcoming().length) {
      await folder.session.edited.value?.settled(); // what was just checked is none any more
      this.passed.value.clear();
    }
    const [next, ...after] = this.upcoming();
    if (next) {
      await this.go(next);
      this.ready(after);
    } else {
      this.looking.value = null;
      folder.session.bulletin.tell("Every segment of every recording is checked.");
    }
  }

  /** Opens the recording of a place, and shows it. */
  async go(place: Place): Promise<void> {
    const { session } = this.folder;
    this.looking.value = place;
    if (session.store.recording.value?.id === place.id) this.show(place);
    else await session.open(place.id, { shown: () => this.show(place) });
  }

  private show(place: Place): void {
    const { store } = this.folder.session;
    const table = store.recording.value;
    if (table?.id !== place.id || this.looking.value !== place) return; // not the last one chosen
    store.lookAt(presentOf(table.segmentation, place.doubt.segment));
  }

  /** What is looked at comes last from now on, wherever an edit has moved its start. */
  private passPresent(): void {
    const { looking } = this;
    const { recording, target } = this.folder.session.store;
    if (!looking.value) return;
    this.passed.value.add(keyOf(looking.value));
    if (target.value && recording.value?.id === looking.value.id)
      this.passed.value.add(keyOf({ id: looking.value.id, doubt: { segment: target.value } }));
  }

  /** The next places that were not passed over. */
  private upcoming(): Place[] {
    const { value: passed } = this.passed;
    return firstOf(this.places.value, (each) => !passed.has(keyOf(each)));
  }

  /** Has the server open the recordings that come next. */
  private ready(places: readonly Place[]): void {
    const { session } = this.folder;
    const present = session.recordings.value.map(({ id }) => id);
    const ids = [...new Set(places.map(({ id }) => id))].filter((id) => !present.includes(id));
    for (const id of ids.slice(0, AHEAD)) {
      if (this.readied.has(id)) continue;
      this.readied.add(id);
      if (this.readied.size > AHEAD * 3) this.readied.delete([...this.readied][0]!);
      session.api.recording(id).catch(() => undefined); // opening it will say what is wrong
    }
  }
}

const kept = new WeakMap<Segments, Place[]>();

function placesOf(id: string, recording: string, table: Segments): Place[] {
  let found = kept.get(table);
  if (!found) {
    found = queueOf(table).map((doubt) => ({ id, recording, doubt }));
    kept.set(table, found);
  }
  return found;
}

/** The first few that are so. */
function firstOf(places: readonly Place[], holds: (place: Place) => boolean): Place[] {
  const found: Place[] = [];
  for (const place of places) {
    if (holds(place)) found.push(place);
    if (found.length > 12) break;
  }
  return found;
}

/** Where it starts; an edit of its end makes it no other. */
function keyOf({ id, doubt: { segment } }: Key): string {
  return `${id} ${segment.level} ${segment.start_frame}`;
}

/** The segment as the table has it now: that which starts there, else that which holds the frame. */
function presentOf({ segments }: Segments, { level, start_frame }: Segment): Segment {
  const lane = segments.filter((each) => each.level === level);
  return lane[Math.max(indexAt(lane, start_frame), 0)] ?? segments[0]!;
}
