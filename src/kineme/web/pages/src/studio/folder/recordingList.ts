/** Filter and sort the recordings of the folder. */
import { computed, signal, type ReadonlySignal } from "@preact/signals";
import type { Listing, State } from "../../messages";
import { countChecked } from "../../segments";
import type { EditedRecording } from "../editing/editedRecording";

/** Review status of a recording. */
export type Status = "new" | "corrected" | "labelled" | "checked";
type Order = (typeof ORDERS)[number][0];

export const STATUS_ORDER: readonly Status[] = ["new", "corrected", "labelled", "checked"];

/** Filters of the list. */
export const STATUSES: readonly (readonly [Status | "", string])[] = [
  ["", "all"],
  ...STATUS_ORDER.map((status) => [status, status] as const),
];
/** Orders of the list. */
export const ORDERS = [
  ["name", "by name"],
  ["left", "what is left first"],
  ["size", "largest first"],
] as const;

export class RecordingList {
  readonly search = signal("");
  readonly order = signal<Order>("name");
  readonly status = signal<Status | "">("");
  readonly listed = computed(() => {
    const found = (this.state.value?.recordings ?? []).filter((each) => this.matches(each));
    if (this.order.value === "size") found.sort((a, b) => b.bytes - a.bytes);
    if (this.order.value === "left")
      found.sort(
        (a, b) => STATUS_ORDER.indexOf(this.getStatus(a)) - STATUS_ORDER.indexOf(this.getStatus(b)),
      );
    return found;
  });

  constructor(
    private readonly state: ReadonlySignal<State | null>,
    private readonly recordings: ReadonlySignal<EditedRecording[]>,
  ) {}

  /** Return a recording's status: of the open table, else of the listing. */
  getStatus(listing: Listing): Status {
    const open = this.recordings.value.find((edited) => edited.id === listing.id);
    const { saved, segmentation } = open?.confirmed.value ?? {};
    if (!segmentation || !saved) return listing.corrected ? computeStatus(listing) : "new";
    const { segments } = segmentation;
    return computeStatus({
      segments: segments.length,
      checked: countChecked(segmentation),
      named: segments.filter(({ label }) => label).length,
      to_name: segments.filter(({ kind }) => kind !== "transition").length,
    });
  }

  /** Return whether a recording passes the filter. */
  matches(listing: Listing): boolean {
    const { value: wanted } = this.status;
    const isNamed = listing.name.toLowerCase().includes(this.search.value.trim().toLowerCase());
    return isNamed && (!wanted || this.getStatus(listing) === wanted);
  }
}

function computeStatus(of: Pick<Listing, "segments" | "checked" | "named" | "to_name">): Status {
  if (of.checked > 0 && of.checked >= of.segments) return "checked";
  return of.named > 0 && of.named >= of.to_name ? "labelled" : "corrected";
}
