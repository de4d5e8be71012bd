/** Several people's labels: how far they agree, and a lane each below the recording in front. */
import { computed, effect, signal, untracked } from "@preact/signals";
import type { Agreement } from "../../messages";
import type { OtherResult } from "../../state";
import type { Store } from "../../store";
import type { Bulletin } from "../news";
import { type Api, explain } from "../server/api";

interface Around {
  api: Api;
  store: Store;
  bulletin: Bulletin;
  open(id: string): Promise<void>;
}

export class People {
  /** How far those agree who were compared last; null where nobody is. */
  readonly agreement = signal<Agreement | null>(null);
  /** The same of the recording in front; undefined where two of them have not labelled it. */
  readonly ofRecording = computed(() => {
    const id = this.around.store.recording.value?.id;
    return this.agreement.value?.recordings.find((each) => each.id === id);
  });

  private chosen: string[] = [];
  private lanes: { recording: string; shown: OtherResult[] } | null = null;

  constructor(private readonly around: Around) {
    const { store } = around;
    effect(() => {
      const id = store.recording.value?.id;
      if (!this.agreement.value || !id || store.others.value.length) return;
      untracked(() => void this.lay(id));
    });
  }

  /** Compares people over the folder, on a recording that two of them labelled; whether it could. */
  compare(annotators: string[]): Promise<boolean> {
    const { api, store, bulletin } = this.around;
    return bulletin.attempt("agreement", async () => {
      const found = await api.agreement({ annotators });
      this.chosen = annotators;
      this.lanes = null;
      store.others.value = [];
      this.agreement.value = found;
      if (!this.ofRecording.value) await this.around.open(found.recordings[0]!.id);
    });
  }

  stop(): void {
    this.agreement.value = null;
    this.lanes = null;
    this.around.store.others.value = [];
  }

  /** Lays the lanes of a recording below it, once they are there and it is still in front. */
  private async lay(recording: string): Promise<void> {
    const { api, store, bulletin } = this.around;
    if (this.lanes?.recording !== recording) {
      this.lanes = { recording, shown: [] }; // asked for once
      const { chosen: annotators, agreement, lanes } = this;
      const asked = agreement.value;
      try {
        const found = await api.lanes(recording, { annotators });
        if (agreement.peek() !== asked || this.lanes !== lanes) return;
        this.lanes.shown = found;
      } catch (error) {
        bulletin.problem(explain(error), "agreement");
      }
    }
    const isFree = store.recording.peek()?.id === recording && !store.others.peek().length;
    if (isFree && this.lanes?.shown.length) store.others.value = this.lanes.shown;
  }
}
