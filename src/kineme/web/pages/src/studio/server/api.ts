/**
 * Send all requests of the studio. A request ends in its answer, in `Refused` (the server explains
 * why) or in `Unreachable` (no answer; it may have been carried out). Nothing else is thrown.
 */

import type * as messages from "../../messages";

import { buildAddress, type PathParts, type Query } from "./address";
import {
  parseFilename,
  nullIfMissing,
  parseJson,
  Refused,
  getErrorMessage,
  Unreachable,
  catchNetworkError,
  type Download,
} from "./answers";
import type { GetPath, PostPath } from "./paths";

export { explainError, Refused, Unreachable, type Download } from "./answers";

/** Milliseconds between attempts to reach the server. */
export const RETRY_INTERVAL = 1000;

export class Api {
  /** @param token from the address that the server printed; each server has its own */
  constructor(public token: string) {}

  loadState(): Promise<messages.State> {
    return this.get("/api/state", {});
  }

  /** Return the tables of all recordings of the folder. */
  loadTables(): Promise<messages.FolderTables> {
    return this.get("/api/tables", {});
  }

  loadRecording(id: string): Promise<messages.Recording> {
    return this.get("/api/recordings/{id}", { id });
  }

  async loadMotion(id: string, poses: number): Promise<ArrayBuffer> {
    const answer = await this.request(
      buildAddress("/api/recordings/{id}/motion", { id }, { poses }),
    );
    return catchNetworkError(answer.arrayBuffer());
  }

  async loadKeypoints(id: string): Promise<ArrayBuffer> {
    const answer = await this.request(buildAddress("/api/recordings/{id}/keypoints", { id }));
    return catchNetworkError(answer.arrayBuffer());
  }

  /** Return a tile of the matrix, or null. */
  loadTile(id: string, level: number, row: number, column: number): Promise<Blob | null> {
    const path = "/api/recordings/{id}/matrix/{level}/{row}/{column}";
    const asked = this.request(buildAddress(path, { id, level, row, column }));
    return nullIfMissing(asked.then((answer) => catchNetworkError(answer.blob())));
  }

  loadCurves(id: string): Promise<messages.CurveList> {
    return this.get("/api/recordings/{id}/curves", { id });
  }

  /** Return a tile of a curve, or null. */
  loadCurveTile(
    id: string,
    curve: number,
    level: number,
    number: number,
  ): Promise<ArrayBuffer | null> {
    const path = "/api/recordings/{id}/curves/{curve}/{level}/{number}";
    const asked = this.request(buildAddress(path, { id, curve, level, number }));
    return nullIfMissing(asked.then((answer) => catchNetworkError(answer.arrayBuffer())));
  }

  async loadCycleChannels(id: string): Promise<messages.CycleChannel[]> {
    const answer: messages.CycleChannels = await this.get("/api/recordings/{id}/cycles", { id });
    return answer.channels;
  }

  /** Return the curves of a cluster, with another recording's mean; null if there are none. */
  loadClusterCurves(
    id: string,
    cluster: number,
    channel: string,
    beside = "",
  ): Promise<messages.ClusterCurves | null> {
    const path = "/api/recordings/{id}/cycles/{cluster}";
    const query: Record<string, string> = beside ? { channel, beside } : { channel };
    return nullIfMissing(
      this.get<messages.ClusterCurves, typeof path>(path, { id, cluster }, query),
    );
  }

  sendEdit(id: string, request: messages.EditRequest): Promise<messages.Edited> {
    return this.post("/api/recordings/{id}/edits", { id }, request);
  }

  loadPreview(id: string, request: messages.PreviewRequest): Promise<messages.Preview> {
    return this.post("/api/recordings/{id}/preview", { id }, request);
  }

  /** Return the progress of the computation for a recording. */
  loadProgress(id: string): Promise<messages.Progress> {
    return this.get("/api/recordings/{id}/progress", { id });
  }

  /** Cancel the computation for a recording. */
  async cancel(id: string): Promise<void> {
    await this.request(buildAddress("/api/recordings/{id}/cancel", { id }), {});
  }

  /** Return the replaced tables. */
  async loadVersions(id: string): Promise<messages.Version[]> {
    const answer: messages.Versions = await this.get("/api/recordings/{id}/versions", { id });
    return answer.versions;
  }

  loadVersion(id: string, number: number): Promise<messages.Comparison> {
    return this.get("/api/recordings/{id}/versions/{number}", { id, number });
  }

  compare(id: string, request: messages.CompareRequest): Promise<messages.Comparison> {
    return this.post("/api/recordings/{id}/compare", { id }, request);
  }

  /** Return who labelled recordings of the folder. */
  loadAnnotators(): Promise<messages.AnnotatorChoice[]> {
    return this.get("/api/annotators", {});
  }

  /** Return how well people agree over the folder. */
  loadAgreement(request: messages.AgreementRequest): Promise<messages.Agreement> {
    return this.post("/api/agreement", {}, request);
  }

  /** Return their labels of a recording. */
  loadLanes(id: string, request: messages.AgreementRequest): Promise<messages.LabelLane[]> {
    return this.post("/api/recordings/{id}/lanes", { id }, request);
  }

  /** Export the segments of a level, or of all levels that the format holds. */
  exportSegments(id: string, format: string, level: messages.Level | ""): Promise<Download> {
    const path = "/api/recordings/{id}/export/{format}";
    return this.download(buildAddress(path, { id, format }, { level }));
  }

  /** Export all checked recordings. */
  exportAll(format: string, level: messages.Level | ""): Promise<Download> {
    return this.download(buildAddress("/api/export/{format}", { format }, { level }));
  }

  /** Export rows of the table as motion files. */
  exportClips(id: string, request: messages.ClipsRequest): Promise<Download> {
    return this.download(buildAddress("/api/recordings/{id}/clips", { id }), request);
  }

  /** Return the quality of the repetitions as loops. */
  async loadLoops(id: string): Promise<messages.LoopRow[]> {
    const answer: messages.Loops = await this.get("/api/recordings/{id}/loops", { id });
    return answer.loops;
  }

  /** Return one round of the loop made from a row of the table. */
  loadLoop(id: string, number: number): Promise<messages.PlayedLoop> {
    return this.get("/api/recordings/{id}/loops/{number}", { id, number });
  }

  /** Rename a cluster in all recordings: by the library's number, or by its previous name. */
  renameEverywhere(
    request: messages.CallEverywhere,
    ofLibrary: boolean,
  ): Promise<messages.TablesChanged> {
    return this.post(ofLibrary ? "/api/library/everywhere" : "/api/names", {}, request);
  }

  shareLabels(request: messages.LabelsRequest): Promise<string[]> {
    return this.post("/api/labels", {}, request);
  }

  makeKnowledge(request: messages.KnowledgeRequest): Promise<messages.FileChoice> {
    return this.post("/api/knowledge", {}, request);
  }

  /** Change how a file is read; return the ids of the resulting recordings. */
  readAs(id: string, request: messages.ReadRequest): Promise<string[]> {
    return this.post("/api/recordings/{id}/reading", { id }, request);
  }

  /** Return the progress of pose estimation. */
  loadPosesProgress(): Promise<messages.PosesProgress> {
    return this.get("/api/poses", {});
  }

  estimatePoses(request: messages.PosesRequest): Promise<messages.PosesProgress> {
    return this.post("/api/poses", {}, request);
  }

  async cancelPoses(): Promise<void> {
    await this.request(buildAddress("/api/poses/cancel", {}), {});
  }

  /** Return the address of a recording's video. */
  getVideoAddress(id: string): string {
    return buildAddress("/api/recordings/{id}/video", { id }, { token: this.token });
  }

  placeVideo(id: string, request: messages.VideoRequest): Promise<messages.VideoRequest> {
    return this.post("/api/recordings/{id}/video", { id }, request);
  }

  /** Upload a file to the folder; `progress` gets the sent share, 0 to 1. */
  upload(file: File, progress: (share: number) => void): Promise<messages.Listing> {
    return new Promise((resolve, reject) => {
      const request = new XMLHttpRequest(); // fetch does not report upload progress
      request.open("POST", buildAddress("/api/recordings", {}, { name: file.name }));
      request.setRequestHeader("X-Kineme-Token", this.token);
      request.setRequestHeader("Content-Type", "application/octet-stream");
      request.upload.onprogress = (event) => {
        if (event.lengthComputable) progress(event.loaded / event.total);
      };
      request.onerror = () => reject(new Unreachable());
      request.onload = () => {
        const body = parseJson(request.responseText);
        if (request.status < 300) resolve(body as messages.Listing);
        else reject(new Refused(request.status, getErrorMessage(body, request.status), body));
      };
      request.send(file);
    });
  }

  /** Listen to the server's events and to changes of the connection; reconnect automatically. */
  listen<T = messages.Changed>(
    told: (news: T) => void,
    line: (up: boolean) => void,
    up = true,
  ): void {
    const source = new EventSource(buildAddress("/api/events", {}, { token: this.token }));
    source.onmessage = (event) => told(JSON.parse(event.data as string) as T);
    source.onopen = () => {
      if (!up) line(true);
      up = true;
    };
    source.onerror = () => {
      source.close();
      if (up) line(false);
      setTimeout(() => this.listen(told, line, false), RETRY_INTERVAL);
    };
  }

  private async download(address: string, body?: unknown): Promise<Download> {
    const answer = await this.request(address, body);
    const name = parseFilename(answer.headers.get("content-disposition") ?? "") || "kineme";
    return { name, data: await catchNetworkError(answer.blob()) };
  }

  protected async get<T, P extends GetPath>(
    path: P,
    parts: PathParts<P>,
    query?: Query,
  ): Promise<T> {
    const answer = await this.request(buildAddress(path, parts, query));
    return (await catchNetworkError(answer.json())) as T;
  }

  protected async post<T, P extends PostPath>(
    path: P,
    parts: PathParts<P>,
    request: unknown,
  ): Promise<T> {
    const answer = await this.request(buildAddress(path, parts), request);
    return (await catchNetworkError(answer.json())) as T;
  }

  private async request(address: string, body?: unknown): Promise<Response> {
    const headers: Record<string, string> = { "X-Kineme-Token": this.token };
    if (body !== undefined) headers["Content-Type"] = "application/json";
    const answer = await catchNetworkError(
      fetch(address, {
        method: body === undefined ? "GET" : "POST",
        headers,
        body: body === undefined ? null : JSON.stringify(body),
        cache: "no-store",
      }),
    );
    if (answer.ok) return answer;
    const failure = parseJson(await catchNetworkError(answer.text()));
    throw new Refused(answer.status, getErrorMessage(failure, answer.status), failure);
  }
}
