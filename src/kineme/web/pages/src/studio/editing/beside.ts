/** What is laid below the table: a segmentation that may be made, a result to compare with. */
import { computed, signal, type ReadonlySignal } from "@preact/signals";
import type { Comparison, CompareRequest, Preview } from "../../messages";
import type { OtherResult } from "../../state";
import type { Store } from "../../store";
import type { Bulletin } from "../news";
import { type Api, explain } from "../server/api";
import type { EditedRecording } from "./editedRecording";

/** A preset, its constants, and how fine the segments are: 1 as usual, less is coarser. */
export interface Choice {
  preset: string;
  values: Record<string, number>;
  detail: number;
}

export interface Proposal {
  choice: Choice;
  keep: boolean;
  preview: Preview;
  shown: OtherResult;
  /** Of the table that it would take the place of. */
  revision: number;
}

interface Around {
  api: Api;
  store: Store;
  bulletin: Bulletin;
  edited: ReadonlySignal<EditedRecording | undefined>;
}

export class Beside {
  /** A segmentation that is shown, but not made; only as long as it lies beside the table. */
  readonly proposal = computed(() =>
    this.proposed.value?.shown === this.around.store.others.value[0] ? this.proposed.value : null,
  );
  /** Another result beside the shown one. */
  readonly comparison = computed(() =>
    this.proposal.value
      ? null
      : (this.compared.value.get(this.around.store.others.value[0]!) ?? null),
  );

  /** What a preview is being found for. */
  readonly draft = signal<Choice | null>(null);

  private readonly proposed = signal<Proposal | null>(null);
  private readonly compared = signal(new WeakMap<OtherResult, Comparison>());
  private asked = 0;

  constructor(private readonly around: Around) {}

  /** Shows what a segmentation would make of the table, which stays as it is. */
  async propose(choice: Choice, keep: boolean): Promise<void> {
    const edited = this.around.edited.value;
    if (!edited) return;
    const turn = ++this.asked;
    this.draft.value = choice;
    const { revision } = edited.confirmed.peek();
    try {
      const { preset, values: parameters, detail } = choice;
      const request = { preset, parameters, detail, keep };
      const preview = await this.around.api.preview(edited.id, request);
      if (turn !== this.asked || this.around.edited.peek() !== edited) return;
      const shown = { name: "Preview", segmentation: preview.segmentation, marked: true };
      this.proposed.value = { choice, keep, preview, shown, revision };
      this.around.store.others.value = [shown];
      this.around.bulletin.solved("preview");
    } catch (error) {
      if (turn === this.asked) this.around.bulletin.problem(explain(error), "preview");
    } finally {
      if (turn === this.asked) this.draft.value = null;
    }
  }

  /** The preview that is being found is not wanted any more; what was shown before stays. */
  cancel(): void {
    this.asked += 1;
    this.draft.value = null;
  }

  /** Makes the shown segmentation the table. */
  apply(): void {
    const { value: proposal } = this.proposal;
    if (!proposal || !this.around.edited.value?.takesEdits()) return;
    const { choice, keep } = proposal;
    this.discard();
    void this.around.edited.value?.edit({
      kind: "segment",
      preset: choice.preset,
      parameters: choice.values,
      detail: choice.detail,
      keep,
    });
  }

  discard(): void {
    this.cancel();
    if (this.proposal.value) this.around.store.others.value = [];
    this.proposed.value = null;
  }

  /** Lays another result below the shown one; whether there is one. */
  async compare(request: CompareRequest): Promise<boolean> {
    const edited = this.around.edited.value;
    if (!edited) return false;
    return this.around.bulletin.attempt("compare", async () =>
      this.lay(await this.around.api.compare(edited.id, request)),
    );
  }

  /** Lays a result below the shown one. */
  lay(comparison: Comparison, marked = false): void {
    const shown = { name: comparison.name, segmentation: comparison.segmentation, marked };
    this.compared.value.set(shown, comparison);
    this.around.store.others.value = [shown];
  }

  stop(): void {
    this.around.store.others.value = [];
  }
}
