/** Load the data of one recording from the studio's server. */
import type { ClusterCurves, CurveList, CycleChannel, Recording } from "../../messages";
import type { RecordingData } from "../../recordingData";
import type { Api } from "./api";

export class ServerData implements RecordingData {
  private channels: Promise<CycleChannel[]> | null = null;

  constructor(
    private readonly api: Api,
    private readonly id: string,
  ) {}

  loadRecording(): Promise<Recording> {
    return this.api.loadRecording(this.id);
  }

  loadMotion(n_samples: number): Promise<ArrayBuffer> {
    return this.api.loadMotion(this.id, n_samples);
  }

  loadKeypoints(): Promise<ArrayBuffer> {
    return this.api.loadKeypoints(this.id);
  }

  getVideoAddresses(): string[] {
    return [this.api.getVideoAddress(this.id)];
  }

  loadTile(level: number, row: number, column: number): Promise<Blob | null> {
    return this.api.loadTile(this.id, level, row, column);
  }

  loadCurves(): Promise<CurveList | null> {
    return this.api.loadCurves(this.id);
  }

  loadCurveTile(curve: number, level: number, number: number): Promise<ArrayBuffer | null> {
    return this.api.loadCurveTile(this.id, curve, level, number);
  }

  loadCycleChannels(): Promise<CycleChannel[]> {
    this.channels ??= this.api.loadCycleChannels(this.id).catch((error: unknown) => {
      this.channels = null; // the next call requests them again
      throw error;
    });
    return this.channels;
  }

  loadClusterCurves(
    cluster: number,
    channel: string,
    _: number,
    beside?: string,
  ): Promise<ClusterCurves | null> {
    return this.api.loadClusterCurves(this.id, cluster, channel, beside);
  }
}
