/**
 * Every request the studio makes, and what can become of it.
 *
 * A request ends in its answer, in `Refused` (the server says no, with a
 * sentence why), or in `Unreachable` (nobody answers; it may or may not have
 * been carried out). Nothing else is thrown.
 */

import type {
  Agreement,
  AgreementRequest,
  AnnotatorChoice,
  CallEverywhere,
  Changed,
  ClipsRequest,
  ClusterCurves,
  CompareRequest,
  Comparison,
  CurveList,
  CycleChannel,
  CycleChannels,
  Edited,
  EditRequest,
  FileChoice,
  FolderTables,
  KnowledgeRequest,
  LabelLane,
  LabelsRequest,
  LoopRow,
  Loops,
  Level,
  Listing,
  PlayedLoop,
  PosesProgress,
  PosesRequest,
  Preview,
  ReadRequest,
  PreviewRequest,
  Progress,
  Recording,
  State,
  TablesChanged,
  Version,
  Versions,
  VideoRequest,
} from "../../messages";

import { addressOf, type Parts, type Query } from "./address";
import {
  filename,
  orNull,
  parsed,
  Refused,
  sentence,
  Unreachable,
  unbroken,
  type Download,
} from "./answers";
import type { GetPath, PostPath } from "./paths";

export { explain, Refused, Unreachable, type Download } from "./answers";

/** Milliseconds between two tries to reach the server. */
export const RETRY = 1000;

export class Api {
  /** @param token what the server printed in its address; another server has another one */
  constructor(public token: string) {}

  state(): Promise<State> {
    return this.get("/api/state", {});
  }

  /** The tables of all recordings of the folder. */
  tables(): Promise<FolderTables> {
    return this.get("/api/tables", {});
  }

  recording(id: string): Promise<Recording> {
    return this.get("/api/recordings/{id}", { id });
  }

  async motion(id: string, poses: number): Promise<ArrayBuffer> {
    const answer = await this.ask(addressOf("/api/recordings/{id}/motion", { id }, { poses }));
    return unbroken(answer.arrayBuffer());
  }

  async keypoints(id: string): Promise<ArrayBuffer> {
    const answer = await this.ask(addressOf("/api/recordings/{id}/keypoints", { id }));
    return unbroken(answer.arrayBuffer());
  }

  /** A tile of the matrix; null where the server has none. */
  tile(id: string, level: number, row: number, column: number): Promise<Blob | null> {
    const path = "/api/recordings/{id}/matrix/{level}/{row}/{column}";
    const asked = this.ask(addressOf(path, { id, level, row, column }));
    return orNull(asked.then((answer) => unbroken(answer.blob())));
  }

  curves(id: string): Promise<CurveList> {
    return this.get("/api/recordings/{id}/curves", { id });
  }

  /** Part of a curve; null where the server has none. */
  curveTile(id: string, curve: number, level: number, number: number): Promise<ArrayBuffer | null> {
    const path = "/api/recordings/{id}/curves/{curve}/{level}/{number}";
    const asked = this.ask(addressOf(path, { id, curve, level, number }));
    return orNull(asked.then((answer) => unbroken(answer.arrayBuffer())));
  }

  async cycleChannels(id: string): Promise<CycleChannel[]> {
    const answer: CycleChannels = await this.get("/api/recordings/{id}/cycles", { id });
    return answer.channels;
  }

  /** The repetitions of a cluster, beside those of another recording; null where there are none. */
  clusterCurves(
    id: string,
    cluster: number,
    channel: string,
    beside = "",
  ): Promise<ClusterCurves | null> {
    const path = "/api/recordings/{id}/cycles/{cluster}";
    const query: Record<string, string> = beside ? { channel, beside } : { channel };
    return orNull(this.get<ClusterCurves, typeof path>(path, { id, cluster }, query));
  }

  edit(id: string, request: EditRequest): Promise<Edited> {
    return this.post("/api/recordings/{id}/edits", { id }, request);
  }

  preview(id: string, request: PreviewRequest): Promise<Preview> {
    return this.post("/api/recordings/{id}/preview", { id }, request);
  }

  /** What the server computes for a recording. */
  progress(id: string): Promise<Progress> {
    return this.get("/api/recordings/{id}/progress", { id });
  }

  /** What the server computes for a recording is not wanted any more. */
  async cancel(id: string): Promise<void> {
    await this.ask(addressOf("/api/recordings/{id}/cancel", { id }), {});
  }

  /** The tables that were replaced. */
  async versions(id: string): Promise<Version[]> {
    const answer: Versions = await this.get("/api/recordings/{id}/versions", { id });
    return answer.versions;
  }

  version(id: string, number: number): Promise<Comparison> {
    return this.get("/api/recordings/{id}/versions/{number}", { id, number });
  }

  compare(id: string, request: CompareRequest): Promise<Comparison> {
    return this.post("/api/recordings/{id}/compare", { id }, request);
  }

  /** Who labelled recordings of the folder. */
  annotators(): Promise<AnnotatorChoice[]> {
    return this.get("/api/annotators", {});
  }

  /** How far people agree, over the folder. */
  agreement(request: AgreementRequest): Promise<Agreement> {
    return this.post("/api/agreement", {}, request);
  }

  /** What they say of a recording. */
  lanes(id: string, request: AgreementRequest): Promise<LabelLane[]> {
    return this.post("/api/recordings/{id}/lanes", { id }, request);
  }

  /** The segments of a level, or of all that the format holds, as a file named by the server. */
  exported(id: string, format: string, level: Level | ""): Promise<Download> {
    const path = "/api/recordings/{id}/export/{format}";
    return this.download(addressOf(path, { id, format }, { level }));
  }

  /** The same of all recordings that are checked. */
  exportedTogether(format: string, level: Level | ""): Promise<Download> {
    return this.download(addressOf("/api/export/{format}", { format }, { level }));
  }

  /** Some rows of the table as motion files. */
  clips(id: string, request: ClipsRequest): Promise<Download> {
    return this.download(addressOf("/api/recordings/{id}/clips", { id }), request);
  }

  /** How good the repetitions would be as loops. */
  async loops(id: string): Promise<LoopRow[]> {
    const answer: Loops = await this.get("/api/recordings/{id}/loops", { id });
    return answer.loops;
  }

  /** A round of the loop that a row of the table would be written as. */
  loop(id: string, number: number): Promise<PlayedLoop> {
    return this.get("/api/recordings/{id}/loops/{number}", { id, number });
  }

  /** What a cluster is called holds in all recordings: by the library, or by the name it had. */
  callEverywhere(request: CallEverywhere, ofLibrary: boolean): Promise<TablesChanged> {
    return this.post(ofLibrary ? "/api/library/everywhere" : "/api/names", {}, request);
  }

  shareLabels(request: LabelsRequest): Promise<string[]> {
    return this.post("/api/labels", {}, request);
  }

  makeKnowledge(request: KnowledgeRequest): Promise<FileChoice> {
    return this.post("/api/knowledge", {}, request);
  }

  /** How a file is read from now on; the recordings that are asked for. */
  readAs(id: string, request: ReadRequest): Promise<string[]> {
    return this.post("/api/recordings/{id}/reading", { id }, request);
  }

  /** How far the server is with the poses of videos. */
  posesProgress(): Promise<PosesProgress> {
    return this.get("/api/poses", {});
  }

  estimatePoses(request: PosesRequest): Promise<PosesProgress> {
    return this.post("/api/poses", {}, request);
  }

  async cancelPoses(): Promise<void> {
    await this.ask(addressOf("/api/poses/cancel", {}), {});
  }

  /** Where the video of a recording comes from. */
  videoAddress(id: string): string {
    return addressOf("/api/recordings/{id}/video", { id }, { token: this.token });
  }

  placeVideo(id: string, request: VideoRequest): Promise<VideoRequest> {
    return this.post("/api/recordings/{id}/video", { id }, request);
  }

  /** A file into the folder; `progress` is told the share sent, 0 to 1. */
  upload(file: File, progress: (share: number) => void): Promise<Listing> {
    return new Promise((resolve, reject) => {
      const request = new XMLHttpRequest(); // fetch cannot tell how much is sent
      request.open("POST", addressOf("/api/recordings", {}, { name: file.name }));
      request.setRequestHeader("X-Kineme-Token", this.token);
      request.setRequestHeader("Content-Type", "application/octet-stream");
      request.upload.onprogress = (event) => {
        if (event.lengthComputable) progress(event.loaded / event.total);
      };
      request.onerror = () => reject(new Unreachable());
      request.onload = () => {
        const body = parsed(request.responseText);
        if (request.status < 300) resolve(body as Listing);
        else reject(new Refused(request.status, sentence(body, request.status), body));
      };
      request.send(file);
    });
  }

  /** Calls back for all news, and when the line drops or returns; it is set up again by itself. */
  listen<T = Changed>(told: (news: T) => void, line: (up: boolean) => void, up = true): void {
    const source = new EventSource(addressOf("/api/events", {}, { token: this.token }));
    source.onmessage = (event) => told(JSON.parse(event.data as string) as T);
    source.onopen = () => {
      if (!up) line(true);
      up = true;
    };
    source.onerror = () => {
      source.close();
      if (up) line(false);
      setTimeout(() => this.listen(told, line, false), RETRY);
    };
  }

  private async download(address: string, body?: unknown): Promise<Download> {
    const answer = await this.ask(address, body);
    const name = filename(answer.headers.get("content-disposition") ?? "") || "kineme";
    return { name, data: await unbroken(answer.blob()) };
  }

  protected async get<T, P extends GetPath>(path: P, parts: Parts<P>, query?: Query): Promise<T> {
    const answer = await this.ask(addressOf(path, parts, query));
    return (await unbroken(answer.json())) as T;
  }

  protected async post<T, P extends PostPath>(
    path: P,
    parts: Parts<P>,
    request: unknown,
  ): Promise<T> {
    const answer = await this.ask(addressOf(path, parts), request);
    return (await unbroken(answer.json())) as T;
  }

  private async ask(address: string, body?: unknown): Promise<Response> {
    const headers: Record<string, string> = { "X-Kineme-Token": this.token };
    if (body !== undefined) headers["Content-Type"] = "application/json";
    const answer = await unbroken(
      fetch(address, {
        method: body === undefined ? "GET" : "POST",
        headers,
        body: body === undefined ? null : JSON.stringify(body),
        cache: "no-store",
      }),
    );
    if (answer.ok) return answer;
    const failure = parsed(await unbroken(answer.text()));
    throw new Refused(answer.status, sentence(failure, answer.status), failure);
  }
}
