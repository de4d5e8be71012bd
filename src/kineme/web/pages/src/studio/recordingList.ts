/** The recordings of the folder, as the list shows them. */
import { computed, signal, type ReadonlySignal } from "@preact/signals";
import type { Listing, State } from "../messages";
import type { EditedRecording } from "./editing/editedRecording";

/** How far a recording is. */
export type Status = "new" | "corrected" | "checked";

export class RecordingList {
  /** What the list of recordings shows. */
  readonly search = signal("");
  readonly wanted = signal<Status | "">("");
  readonly listed = computed(() => {
    const text = this.search.value.trim().toLowerCase();
    const all = this.state.value?.recordings ?? [];
    return all.filter(
      (each) =>
        each.name.toLowerCase().includes(text) &&
        (!this.wanted.value || this.statusOf(each) === this.wanted.value),
    );
  });

  constructor(
    private readonly state: ReadonlySignal<State | null>,
    private readonly recordings: ReadonlySignal<EditedRecording[]>,
  ) {}

  /** How far a recording is: as it is shown, else as the folder was told to be. */
  statusOf(listing: Listing): Status {
    const open = this.recordings.value.find((edited) => edited.id === listing.id);
    const { saved, segmentation } = open?.confirmed.value ?? {};
    if (segmentation && saved)
      return status(segmentation.segments.length, segmentation.checked.length);
    return listing.corrected ? status(listing.segments, listing.checked) : "new";
  }
}

function status(segments: number, checked: number): Status {
  return checked > 0 && checked >= segments ? "checked" : "corrected";
}
