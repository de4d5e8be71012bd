/** The data of one recording, from the studio's server. */
import type { Recording } from "../messages";
import type { Source } from "../source";
import type { Api } from "./api";

export class ServerSource implements Source {
  constructor(
    private readonly api: Api,
    private readonly id: string,
  ) {}

  recording(): Promise<Recording> {
    return this.api.recording(this.id);
  }

  motion(): Promise<ArrayBuffer> {
    return this.api.motion(this.id);
  }

  tile(level: number, row: number, column: number): Promise<Blob | null> {
    return this.api.tile(this.id, level, row, column);
  }
}
