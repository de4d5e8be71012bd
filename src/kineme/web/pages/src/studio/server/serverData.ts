/** The data of one recording, from the studio's server. */
import type { CurveList, Recording } from "../../messages";
import type { RecordingData } from "../../recordingData";
import type { Api } from "./api";

export class ServerData implements RecordingData {
  private coming: Promise<ArrayBuffer> | undefined;

  constructor(
    private readonly api: Api,
    private readonly id: string,
  ) {}

  /** Asks for the motion, which then is on its way while the page shows the rest. */
  askAhead(): this {
    this.coming = this.api.motion(this.id);
    this.coming.catch(() => undefined); // whoever waits for it is told
    return this;
  }

  recording(): Promise<Recording> {
    return this.api.recording(this.id);
  }

  motion(): Promise<ArrayBuffer> {
    const { coming } = this;
    this.coming = undefined;
    return coming ?? this.api.motion(this.id);
  }

  tile(level: number, row: number, column: number): Promise<Blob | null> {
    return this.api.tile(this.id, level, row, column);
  }

  curves(): Promise<CurveList | null> {
    return this.api.curves(this.id);
  }

  piece(curve: number, level: number, number: number): Promise<ArrayBuffer | null> {
    return this.api.piece(this.id, curve, level, number);
  }
}
