/** Load a recording's data: from the page itself (report) or the server (studio). */
import type {
  ClusterCurves,
  CurveList,
  CycleChannel,
  Recording,
  ReportCurves,
  MotionHead,
} from "./messages";
import { inflate, unpackMotion, type Motion } from "./motion";
import type { ReadonlySignal, Signal } from "@preact/signals";

export interface RecordingData {
  /** Return the deflated binary motion (see motion.ts) with the given number of poses. */
  loadMotion(n_samples: number): Promise<ArrayBuffer>;
  /** Return the keypoints in the video, in the format of the motion. */
  loadKeypoints(): Promise<ArrayBuffer>;
  /** Return possible addresses of the video, the most likely first. */
  getVideoAddresses(): string[];
  /** Return a tile of the similarity matrix as PNG, or null. */
  loadTile(level: number, row: number, column: number): Promise<Blob | null>;
  /** Return the available curves, or null. */
  loadCurves(): Promise<CurveList | null>;
  /** Return pairs of minimum and maximum (see kineme.web.curves), or null. */
  loadCurveTile(curve: number, level: number, number: number): Promise<ArrayBuffer | null>;
  /** Return what can be measured of a repetition. */
  loadCycleChannels(): Promise<CycleChannel[]>;
  /**
   * Return a channel over the repetitions of a cluster, in the table of a revision; null if there
   * is none. Without a name it is the channel with the largest range. `beside` is the id of another
   * recording whose mean is included; reports ignore it.
   */
  loadClusterCurves(
    cluster: number,
    channel: string,
    revision: number,
    beside?: string,
  ): Promise<ClusterCurves | null>;
}

/** Read the data from script elements of a report, which no browser runs. */
export class EmbeddedData implements RecordingData {
  private readonly tiles: Record<string, string>;
  private cycles: Promise<ReportCurves> | null = null;
  private readonly drawn: { list: CurveList; tiles: Record<string, string> } | null;

  constructor(private readonly page: Document = document) {
    this.tiles = JSON.parse(this.readText("kineme-tiles") || "{}") as Record<string, string>;
    this.drawn = JSON.parse(this.readText("kineme-curves") || "null") as typeof this.drawn;
  }

  readRecording(): Recording {
    const text = this.readText("kineme-recording");
    if (!text) throw new Error("This page holds no recording.");
    return JSON.parse(text) as Recording;
  }

  loadMotion(): Promise<ArrayBuffer> {
    return Promise.resolve(decodeBase64(this.readText("kineme-motion")).buffer);
  }

  loadKeypoints(): Promise<ArrayBuffer> {
    return Promise.resolve(decodeBase64(this.readText("kineme-keypoints")).buffer);
  }

  /** First the original address, then beside the page, since both are often moved together. */
  getVideoAddresses(): string[] {
    const { video } = this.readRecording();
    return video?.address ? [video.address, encodeURIComponent(video.name)] : [];
  }

  loadTile(level: number, row: number, column: number): Promise<Blob | null> {
    const text = this.tiles[`${level}/${row}/${column}`];
    const blob = text ? new Blob([decodeBase64(text)], { type: "image/png" }) : null;
    return Promise.resolve(blob);
  }

  loadCurves(): Promise<CurveList | null> {
    return Promise.resolve(this.drawn?.list ?? null);
  }

  loadCurveTile(curve: number, level: number, number: number): Promise<ArrayBuffer | null> {
    const text = this.drawn?.tiles[`${curve}/${level}/${number}`];
    return Promise.resolve(text ? decodeBase64(text).buffer : null);
  }

  async loadCycleChannels(): Promise<CycleChannel[]> {
    return (await this.loadMeasurements()).channels;
  }

  async loadClusterCurves(
    cluster: number,
    channel: string,
    revision: number,
  ): Promise<ClusterCurves | null> {
    const { curves, tables } = await this.loadMeasurements();
    const channels = curves[tables[revision]?.[cluster] ?? -1] ?? {};
    return (channel ? channels[channel] : Object.values(channels)[0]) ?? null;
  }

  private loadMeasurements(): Promise<ReportCurves> {
    return (this.cycles ??= inflate(
      decodeBase64(this.readText("kineme-cycles")).buffer,
    ).json() as Promise<ReportCurves>);
  }

  private readText(id: string): string {
    return this.page.getElementById(id)?.textContent?.trim() ?? "";
  }
}

/** Decode base64 text to bytes. */
export function decodeBase64(base64: string): Uint8Array<ArrayBuffer> {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
  return bytes;
}

/** A recording on the page; edits replace the table inside `recording`. */
export interface OpenRecording {
  data: RecordingData;
  recording: ReadonlySignal<Recording>;
  /** null without a skeleton or while loading. */
  motion: Signal<Motion | null>;
  /** Keypoints in the video; null without them or while loading. */
  keypoints: Signal<Motion | null>;
}

/** Return a person's display name; numbers become "person 1". */
export function formatPerson(name: string): string {
  return /^\d+$/.test(name) ? `person ${name}` : name;
}

/** Load a recording's motion, again until all poses of a large recording are there. */
export async function loadMotion(opened: OpenRecording): Promise<void> {
  const keypoints = loadKeypoints(opened);
  for (;;) {
    const { motion: head } = opened.recording.peek(); // it may have changed while loading
    if (!head || isComplete(head, opened.motion.peek())) return keypoints;
    opened.motion.value = await unpackMotion(head, await opened.data.loadMotion(head.n_samples));
  }
}

async function loadKeypoints(opened: OpenRecording): Promise<void> {
  const picture = opened.recording.peek().video?.picture;
  if (!picture || opened.keypoints.peek()) return;
  opened.keypoints.value = await unpackMotion(picture.keypoints, await opened.data.loadKeypoints());
}

function isComplete({ n_samples, step }: MotionHead, motion: Motion | null): boolean {
  return motion?.head.n_samples === n_samples && motion.head.step === step;
}
