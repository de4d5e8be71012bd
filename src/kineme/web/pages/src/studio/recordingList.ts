/** The recordings of the folder, as the list shows them. */
import { computed, signal, type ReadonlySignal } from "@preact/signals";
import type { Listing, State } from "../messages";
import { checkedIn } from "../segments";
import type { EditedRecording } from "./editing/editedRecording";

/** How far a recording is. */
export type Status = "new" | "corrected" | "labelled" | "checked";
type Order = (typeof ORDERS)[number][0];

const FAR: readonly Status[] = ["new", "corrected", "labelled", "checked"];

/** What the list can be narrowed to. */
export const STATUSES: readonly (readonly [Status | "", string])[] = [
  ["", "all"],
  ...FAR.map((status) => [status, status] as const),
];
/** What the list can be ordered by. */
export const ORDERS = [
  ["name", "by name"],
  ["left", "what is left first"],
  ["size", "largest first"],
] as const;

export class RecordingList {
  /** What the list of recordings shows. */
  readonly search = signal("");
  readonly order = signal<Order>("name");
  readonly status = signal<Status | "">("");
  readonly listed = computed(() => {
    const text = this.search.value.trim().toLowerCase();
    const all = this.state.value?.recordings ?? [];
    const found = all.filter(
      (each) =>
        each.name.toLowerCase().includes(text) &&
        (!this.status.value || this.statusOf(each) === this.status.value),
    );
    if (this.order.value === "size") found.sort((a, b) => b.bytes - a.bytes);
    if (this.order.value === "left")
      found.sort((a, b) => FAR.indexOf(this.statusOf(a)) - FAR.indexOf(this.statusOf(b)));
    return found;
  });

  constructor(
    private readonly state: ReadonlySignal<State | null>,
    private readonly recordings: ReadonlySignal<EditedRecording[]>,
  ) {}

  /** How far a recording is: as it is shown, else as the folder was told to be. */
  statusOf(listing: Listing): Status {
    const open = this.recordings.value.find((edited) => edited.id === listing.id);
    const { saved, segmentation } = open?.confirmed.value ?? {};
    if (!segmentation || !saved) return listing.corrected ? status(listing) : "new";
    const { segments } = segmentation;
    return status({
      segments: segments.length,
      checked: checkedIn(segmentation),
      named: segments.filter(({ label }) => label).length,
      to_name: segments.filter(({ kind }) => kind !== "transition").length,
    });
  }

  isChecked(listing: Listing): boolean {
    return this.statusOf(listing) === "checked";
  }
}

function status(of: Pick<Listing, "segments" | "checked" | "named" | "to_name">): Status {
  if (of.checked > 0 && of.checked >= of.segments) return "checked";
  return of.named > 0 && of.named >= of.to_name ? "labelled" : "corrected";
}
