/** The data of one recording, from the studio's server. */
import type { ClusterCurves, CurveList, CycleChannel, Recording } from "../../messages";
import type { RecordingData } from "../../recordingData";
import type { Api } from "./api";

export class ServerData implements RecordingData {
  private channels: Promise<CycleChannel[]> | null = null;

  constructor(
    private readonly api: Api,
    private readonly id: string,
  ) {}

  recording(): Promise<Recording> {
    return this.api.recording(this.id);
  }

  motion(n_samples: number): Promise<ArrayBuffer> {
    return this.api.motion(this.id, n_samples);
  }

  keypoints(): Promise<ArrayBuffer> {
    return this.api.keypoints(this.id);
  }

  videoAddresses(): string[] {
    return [this.api.videoAddress(this.id)];
  }

  tile(level: number, row: number, column: number): Promise<Blob | null> {
    return this.api.tile(this.id, level, row, column);
  }

  curves(): Promise<CurveList | null> {
    return this.api.curves(this.id);
  }

  curveTile(curve: number, level: number, number: number): Promise<ArrayBuffer | null> {
    return this.api.curveTile(this.id, curve, level, number);
  }

  cycleChannels(): Promise<CycleChannel[]> {
    this.channels ??= this.api.cycleChannels(this.id).catch((error: unknown) => {
      this.channels = null; // asked for again
      throw error;
    });
    return this.channels;
  }

  clusterCurves(
    cluster: number,
    channel: string,
    _: number,
    beside?: string,
  ): Promise<ClusterCurves | null> {
    return this.api.clusterCurves(this.id, cluster, channel, beside);
  }
}
