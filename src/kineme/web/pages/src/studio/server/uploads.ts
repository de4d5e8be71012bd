/** Upload files to the folder. */
import { signal } from "@preact/signals";
import { explainError } from "./api";
import type { Session } from "../session";

export interface Upload {
  name: string;
  /** Sent share, 0 to 1. */
  share: number;
}

export class Uploads {
  readonly running = signal<Upload[]>([]);

  constructor(private readonly session: Session) {}

  /** Send files one after the other and open the first recording. */
  async add(files: readonly File[]): Promise<void> {
    const { session } = this;
    const ids: string[] = [];
    const uploads = files.map((file) => ({ name: file.name, share: 0 }));
    this.running.value = [...this.running.value, ...uploads];
    for (const [i, file] of files.entries()) {
      let upload = uploads[i]!;
      const progress = (share: number): void => {
        const now = { ...upload, share };
        this.running.value = this.running.value.map((each) => (each === upload ? now : each));
        upload = now;
      };
      try {
        ids.push((await session.api.upload(file, progress)).id);
        session.notifications.clearProblem(`upload ${file.name}`);
      } catch (error) {
        session.notifications.reportProblem(
          `${file.name}: ${explainError(error)}`,
          `upload ${file.name}`,
        );
      }
      this.running.value = this.running.value.filter((each) => each !== upload);
    }
    await session.refresh();
    const listed = new Set(session.state.value?.recordings.map((each) => each.id));
    const first = ids.find((id) => listed.has(id));
    if (first) await session.open(first);
  }
}
