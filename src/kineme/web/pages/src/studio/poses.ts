/** Let the server estimate poses of videos, one after the other. */
import { computed, effect, signal, untracked } from "@preact/signals";
import type { PosesProgress } from "../messages";
import { delay } from "../util";
import { explainError } from "./server/api";
import type { Session } from "./session";

const POLL_INTERVAL = 500; // milliseconds

export class Poses {
  /** Progress; null if nothing runs. */
  readonly progress = signal<PosesProgress | null>(null);
  /** Videos without poses. */
  readonly videos = computed(
    () => this.session.state.value?.recordings.filter((each) => each.needs_poses) ?? [],
  );
  /** The video that the user wants to open. */
  readonly requestedVideo = computed(() =>
    this.videos.value.find((each) => each.id === this.session.videoWithoutPoses.value),
  );
  /** What must be installed first; empty if nothing. */
  readonly install = computed(() => this.session.state.value?.install ?? "");
  private isPolling = false;
  private isNew = true;

  constructor(private readonly session: Session) {
    effect(() => {
      const { value: state } = session.state;
      if (!state || !this.isNew || !this.videos.value.length) return;
      const only = state.recordings.length === 1 ? this.requestedVideo.value : undefined;
      if (state.recordings.length === 1 && !only) return; // it is still being opened
      this.isNew = false;
      // Starting the studio on one video implies estimating its poses; a running queue survives a
      // reload.
      if (only && !state.install) untracked(() => void this.start([only.id]));
      else untracked(() => void this.pollProgress());
    });
  }

  /** Estimate the poses of these videos. */
  async start(ids: readonly string[]): Promise<void> {
    const { api, notifications } = this.session;
    await notifications.attempt("poses", async () => {
      this.progress.value = await api.estimatePoses({ recordings: [...ids] });
    });
    await this.pollProgress();
  }

  async cancel(): Promise<void> {
    const { api, notifications } = this.session;
    await notifications.attempt("poses", () => api.cancelPoses());
    notifications.tell("Cancelled. The poses so far are kept: estimating goes on from there.");
  }

  /** Poll the progress until it is done, then open the requested video. */
  private async pollProgress(): Promise<void> {
    if (this.isPolling) return;
    this.isPolling = true;
    const { api, notifications } = this.session;
    try {
      for (let done = 0; ; await delay(POLL_INTERVAL)) {
        const now = await api.loadPosesProgress();
        if (now.done > done) await this.refresh();
        done = now.done;
        if (now.recording) {
          this.progress.value = now;
          continue;
        }
        const more = now.failed.length > 1 ? ` (and ${now.failed.length - 1} more)` : "";
        if (this.progress.value && now.failed.length)
          notifications.reportProblem(`${now.failed[0]}${more}`, "poses");
        break;
      }
    } catch (error) {
      notifications.reportProblem(explainError(error), "poses");
    }
    this.progress.value = null;
    this.isPolling = false;
  }

  /** Reload the folder and open the requested video once possible. */
  private async refresh(): Promise<void> {
    const { session } = this;
    await session.refresh();
    const { value: needing } = session.videoWithoutPoses;
    if (needing && !this.requestedVideo.value) await session.open(needing);
  }
}
