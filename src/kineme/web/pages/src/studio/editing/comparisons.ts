/** Show other results below the table: a preview or a comparison. */
import { computed, signal, type ReadonlySignal, effect, untracked } from "@preact/signals";
import type { Comparison, CompareRequest, Preview, Agreement } from "../../messages";
import type { OtherResult, Store } from "../../store";
import type { Notifications } from "../notifications";
import { type Api, explainError } from "../server/api";
import type { EditedRecording } from "./editedRecording";

/** A preset, its parameters and the level of detail: 1 is the default, less is coarser. */
export interface SegmentationChoice {
  preset: string;
  values: Record<string, number>;
  detail: number;
}

export interface Proposal {
  choice: SegmentationChoice;
  keep: boolean;
  preview: Preview;
  shown: OtherResult;
  /** Revision of the table that it would replace. */
  revision: number;
}

/** What comparisons need of the session. */
interface PageServices {
  api: Api;
  store: Store;
  notifications: Notifications;
  edited: ReadonlySignal<EditedRecording | undefined>;
  open(id: string): Promise<void>;
}

export class Comparisons {
  /** The previewed segmentation, while it is shown below the table. */
  readonly proposal = computed(() =>
    this.proposed.value?.shown === this.page.store.others.value[0] ? this.proposed.value : null,
  );
  /** The comparison shown below the table. */
  readonly comparison = computed(() =>
    this.proposal.value
      ? null
      : (this.compared.value.get(this.page.store.others.value[0]!) ?? null),
  );

  /** The choice whose preview is being computed. */
  readonly draft = signal<SegmentationChoice | null>(null);

  private readonly proposed = signal<Proposal | null>(null);
  private readonly compared = signal(new WeakMap<OtherResult, Comparison>());
  private requestCount = 0;

  constructor(private readonly page: PageServices) {}

  /** Preview a segmentation without changing the table. */
  async propose(choice: SegmentationChoice, keep: boolean): Promise<void> {
    const edited = this.page.edited.value;
    if (!edited) return;
    const turn = ++this.requestCount;
    this.draft.value = choice;
    const { revision } = edited.confirmed.peek();
    try {
      const { preset, values: parameters, detail } = choice;
      const request = { preset, parameters, detail, keep };
      const preview = await this.page.api.loadPreview(edited.id, request);
      if (turn !== this.requestCount || this.page.edited.peek() !== edited) return;
      const shown = { name: "Preview", segmentation: preview.segmentation, marked: true };
      this.proposed.value = { choice, keep, preview, shown, revision };
      this.page.store.others.value = [shown];
      this.page.notifications.clearProblem("preview");
    } catch (error) {
      if (turn === this.requestCount)
        this.page.notifications.reportProblem(explainError(error), "preview");
    } finally {
      if (turn === this.requestCount) this.draft.value = null;
    }
  }

  /** Cancel the preview being computed; the previous one stays. */
  cancel(): void {
    this.requestCount += 1;
    this.draft.value = null;
  }

  /** Replace the table by the previewed segmentation. */
  apply(): void {
    const { value: proposal } = this.proposal;
    if (!proposal || !this.page.edited.value?.acceptsEdits()) return;
    const { choice, keep } = proposal;
    this.discard();
    void this.page.edited.value?.edit({
      kind: "segment",
      preset: choice.preset,
      parameters: choice.values,
      detail: choice.detail,
      keep,
    });
  }

  discard(): void {
    this.cancel();
    if (this.proposal.value) this.page.store.others.value = [];
    this.proposed.value = null;
  }

  /** Compare with another result; return whether that worked. */
  async compare(request: CompareRequest): Promise<boolean> {
    const edited = this.page.edited.value;
    if (!edited) return false;
    return this.page.notifications.attempt("compare", async () =>
      this.showBelow(await this.page.api.compare(edited.id, request)),
    );
  }

  /** Show a result below the table. */
  showBelow(comparison: Comparison, marked = false): void {
    const shown = { name: comparison.name, segmentation: comparison.segmentation, marked };
    this.compared.value.set(shown, comparison);
    this.page.store.others.value = [shown];
  }

  stop(): void {
    this.page.store.others.value = [];
  }
}

/** Compare several people's labels and show their lanes below the recording. */
export class PeopleComparison {
  /** Agreement of the compared people; null if none are. */
  readonly agreement = signal<Agreement | null>(null);
  /** Agreement on the active recording; undefined if fewer than two labelled it. */
  readonly recordingAgreement = computed(() => {
    const id = this.page.store.recording.value?.id;
    return this.agreement.value?.recordings.find((each) => each.id === id);
  });

  private chosen: string[] = [];
  private lanes: { recording: string; shown: OtherResult[] } | null = null;

  constructor(private readonly page: PageServices) {
    const { store } = page;
    effect(() => {
      const id = store.recording.value?.id;
      if (!this.agreement.value || !id || store.others.value.length) return;
      untracked(() => void this.showLanes(id));
    });
  }

  /** Compare people and open a recording that two of them labelled; return whether that worked. */
  compare(annotators: string[]): Promise<boolean> {
    const { api, store, notifications } = this.page;
    return notifications.attempt("agreement", async () => {
      const found = await api.loadAgreement({ annotators });
      this.chosen = annotators;
      this.lanes = null;
      store.others.value = [];
      this.agreement.value = found;
      if (!this.recordingAgreement.value) await this.page.open(found.recordings[0]!.id);
    });
  }

  stop(): void {
    this.agreement.value = null;
    this.lanes = null;
    this.page.store.others.value = [];
  }

  /** Show a recording's lanes once they are loaded, if it is still active. */
  private async showLanes(recording: string): Promise<void> {
    const { api, store, notifications } = this.page;
    if (this.lanes?.recording !== recording) {
      this.lanes = { recording, shown: [] }; // requested once
      const { chosen: annotators, agreement, lanes } = this;
      const asked = agreement.value;
      try {
        const found = await api.loadLanes(recording, { annotators });
        if (agreement.peek() !== asked || this.lanes !== lanes) return;
        this.lanes.shown = found;
      } catch (error) {
        notifications.reportProblem(explainError(error), "agreement");
      }
    }
    const isFree = store.recording.peek()?.id === recording && !store.others.peek().length;
    if (isFree && this.lanes?.shown.length) store.others.value = this.lanes.shown;
  }
}
