/** Where a page gets its data: out of its own file (report) or from the server (studio). */
import type { ClusterCurves, CurveList, CycleChannel, Recording, ReportCurves } from "./messages";
import { inflated } from "./motion";

export interface RecordingData {
  recording(): Promise<Recording>;
  /** The binary motion as it was sent: deflated, see motion.ts; of as many poses as were told. */
  motion(n_samples: number): Promise<ArrayBuffer>;
  /** The keypoints drawn over the video, as the motion is. */
  keypoints(): Promise<ArrayBuffer>;
  /** Where the video may be, the likeliest place first. */
  videoAddresses(): string[];
  /** A tile of the similarity matrix as PNG, or null where there is none. */
  tile(level: number, row: number, column: number): Promise<Blob | null>;
  /** The curves there are to draw; null where none can be had. */
  curves(): Promise<CurveList | null>;
  /** Pairs of least and greatest values, see kineme.web.curves; null where there is none. */
  curveTile(curve: number, level: number, number: number): Promise<ArrayBuffer | null>;
  /** What can be measured of a repetition. */
  cycleChannels(): Promise<CycleChannel[]>;
  /**
   * A channel over the repetitions of a cluster, in the table of a revision; that one which goes
   * farthest where none is named, null where there is none. `beside` is the id of another
   * recording whose mean comes along; a report knows none.
   */
  clusterCurves(
    cluster: number,
    channel: string,
    revision: number,
    beside?: string,
  ): Promise<ClusterCurves | null>;
}

/** The data inside a report: script elements that no browser runs. */
export class EmbeddedData implements RecordingData {
  private readonly tiles: Record<string, string>;
  private cycles: Promise<ReportCurves> | null = null;
  private readonly drawn: { list: CurveList; tiles: Record<string, string> } | null;

  constructor(private readonly page: Document = document) {
    this.tiles = JSON.parse(this.text("kineme-tiles") || "{}") as Record<string, string>;
    this.drawn = JSON.parse(this.text("kineme-curves") || "null") as typeof this.drawn;
  }

  recording(): Promise<Recording> {
    const text = this.text("kineme-recording");
    if (!text) return Promise.reject(new Error("This page holds no recording."));
    return Promise.resolve(JSON.parse(text) as Recording);
  }

  motion(): Promise<ArrayBuffer> {
    return Promise.resolve(bytesOf(this.text("kineme-motion")).buffer);
  }

  keypoints(): Promise<ArrayBuffer> {
    return Promise.resolve(bytesOf(this.text("kineme-keypoints")).buffer);
  }

  /** Where it was when the page was written, then beside the page: people move them together. */
  videoAddresses(): string[] {
    const { video } = JSON.parse(this.text("kineme-recording")) as Recording;
    return video?.address ? [video.address, encodeURIComponent(video.name)] : [];
  }

  tile(level: number, row: number, column: number): Promise<Blob | null> {
    const text = this.tiles[`${level}/${row}/${column}`];
    const blob = text ? new Blob([bytesOf(text)], { type: "image/png" }) : null;
    return Promise.resolve(blob);
  }

  curves(): Promise<CurveList | null> {
    return Promise.resolve(this.drawn?.list ?? null);
  }

  curveTile(curve: number, level: number, number: number): Promise<ArrayBuffer | null> {
    const text = this.drawn?.tiles[`${curve}/${level}/${number}`];
    return Promise.resolve(text ? bytesOf(text).buffer : null);
  }

  async cycleChannels(): Promise<CycleChannel[]> {
    return (await this.measured()).channels;
  }

  async clusterCurves(
    cluster: number,
    channel: string,
    revision: number,
  ): Promise<ClusterCurves | null> {
    const { curves, tables } = await this.measured();
    const channels = curves[tables[revision]?.[cluster] ?? -1] ?? {};
    return (channel ? channels[channel] : Object.values(channels)[0]) ?? null;
  }

  private measured(): Promise<ReportCurves> {
    const packed = (): ArrayBuffer => bytesOf(this.text("kineme-cycles")).buffer;
    return (this.cycles ??= inflated(packed()).json() as Promise<ReportCurves>);
  }

  private text(id: string): string {
    return this.page.getElementById(id)?.textContent?.trim() ?? "";
  }
}

/** The bytes that base64 text stands for. */
export function bytesOf(base64: string): Uint8Array<ArrayBuffer> {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
  return bytes;
}
