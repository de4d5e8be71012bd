/** Compare several people's labels and show their lanes below the recording. */
import { computed, effect, signal, untracked } from "@preact/signals";
import type { Agreement } from "../../messages";
import type { OtherResult } from "../../state";
import type { Store } from "../../store";
import type { Notifications } from "../notifications";
import { type Api, explainError } from "../server/api";

interface Dependencies {
  api: Api;
  store: Store;
  notifications: Notifications;
  open(id: string): Promise<void>;
}

export class PeopleComparison {
  /** Agreement of the compared people; null if none are. */
  readonly agreement = signal<Agreement | null>(null);
  /** Agreement on the active recording; undefined if fewer than two labelled it. */
  readonly recordingAgreement = computed(() => {
    const id = this.dependencies.store.recording.value?.id;
    return this.agreement.value?.recordings.find((each) => each.id === id);
  });

  private chosen: string[] = [];
  private lanes: { recording: string; shown: OtherResult[] } | null = null;

  constructor(private readonly dependencies: Dependencies) {
    const { store } = dependencies;
    effect(() => {
      const id = store.recording.value?.id;
      if (!this.agreement.value || !id || store.others.value.length) return;
      untracked(() => void this.showLanes(id));
    });
  }

  /** Compare people and open a recording that two of them labelled; return whether that worked. */
  compare(annotators: string[]): Promise<boolean> {
    const { api, store, notifications } = this.dependencies;
    return notifications.attempt("agreement", async () => {
      const found = await api.loadAgreement({ annotators });
      this.chosen = annotators;
      this.lanes = null;
      store.others.value = [];
      this.agreement.value = found;
      if (!this.recordingAgreement.value) await this.dependencies.open(found.recordings[0]!.id);
    });
  }

  stop(): void {
    this.agreement.value = null;
    this.lanes = null;
    this.dependencies.store.others.value = [];
  }

  /** Show a recording's lanes once they are loaded, if it is still active. */
  private async showLanes(recording: string): Promise<void> {
    const { api, store, notifications } = this.dependencies;
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
