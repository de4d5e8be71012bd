/** Poses of videos of the folder, which the server estimates one video after the other. */
import { computed, effect, signal, untracked } from "@preact/signals";
import type { PosesProgress } from "../../messages";
import { later } from "../later";
import { explain } from "../server/api";
import type { Session } from "../session";

const POLL = 500; // milliseconds between two looks at how far it is

export class Poses {
  /** How far the server is; null while it estimates none. */
  readonly progress = signal<PosesProgress | null>(null);
  /** Videos without poses. */
  readonly videos = computed(
    () => this.session.state.value?.recordings.filter((each) => each.needs_poses) ?? [],
  );
  /** The video that was to be opened. */
  readonly asked = computed(() =>
    this.videos.value.find((each) => each.id === this.session.needing.value),
  );
  /** What is to be installed first; empty where nothing is. */
  readonly install = computed(() => this.session.state.value?.install ?? "");
  private watching = false;
  private isNew = true;

  constructor(private readonly session: Session) {
    effect(() => {
      const { value: state } = session.state;
      if (!state || !this.isNew || !this.videos.value.length) return;
      const only = state.recordings.length === 1 ? this.asked.value : undefined;
      if (state.recordings.length === 1 && !only) return; // it is being opened yet
      this.isNew = false;
      // Who starts the studio on one video wants its poses; a queue outlives the page.
      if (only && !state.install) untracked(() => void this.start([only.id]));
      else untracked(() => void this.watch());
    });
  }

  /** Estimates the poses of these videos. */
  async start(ids: readonly string[]): Promise<void> {
    const { api, bulletin } = this.session;
    await bulletin.attempt("poses", async () => {
      this.progress.value = await api.estimatePoses({ recordings: [...ids] });
    });
    await this.watch();
  }

  async cancel(): Promise<void> {
    const { api, bulletin } = this.session;
    await bulletin.attempt("poses", () => api.cancelPoses());
    bulletin.tell("Cancelled. The poses so far are kept: estimating goes on from there.");
  }

  /** Looks how far it is until it is done, and opens the video that was asked for. */
  private async watch(): Promise<void> {
    if (this.watching) return;
    this.watching = true;
    const { api, bulletin } = this.session;
    try {
      for (let done = 0; ; await later(POLL)) {
        const now = await api.posesProgress();
        if (now.done > done) await this.refresh();
        done = now.done;
        if (now.recording) {
          this.progress.value = now;
          continue;
        }
        const more = now.failed.length > 1 ? ` (and ${now.failed.length - 1} more)` : "";
        if (this.progress.value && now.failed.length)
          bulletin.problem(`${now.failed[0]}${more}`, "poses");
        break;
      }
    } catch (error) {
      bulletin.problem(explain(error), "poses");
    }
    this.progress.value = null;
    this.watching = false;
  }

  /** The folder as it is now; the video that was asked for is opened once it can be. */
  private async refresh(): Promise<void> {
    const { session } = this;
    await session.refresh();
    const { value: needing } = session.needing;
    if (needing && !this.asked.value) await session.open(needing);
  }
}
