/**
 * Every request the studio makes, and what can become of it.
 *
 * A request ends in its answer, in `Refused` (the server says no, with a
 * sentence why), or in `Unreachable` (nobody answers; it may or may not have
 * been carried out). Nothing else is thrown.
 */

import type {
  Changed,
  ClipsRequest,
  CompareRequest,
  Comparison,
  CurveList,
  Edited,
  EditRequest,
  FileChoice,
  KnowledgeRequest,
  LabelsRequest,
  Level,
  Listing,
  Preview,
  ReadingRequest,
  PreviewRequest,
  Recording,
  State,
  Version,
  Versions,
  VideoRequest,
} from "../../messages";

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

export { explain, Refused, Unreachable, type Download } from "./answers";

/** Milliseconds between two tries to reach the server. */
export const RETRY = 1000;

export class Api {
  /** @param token what the server printed in its address; another server has another one */
  constructor(public token: string) {}

  state(): Promise<State> {
    return this.json("/api/state");
  }

  recording(id: string): Promise<Recording> {
    return this.json(`/api/recordings/${encodeURIComponent(id)}`);
  }

  async motion(id: string, poses: number): Promise<ArrayBuffer> {
    const path = `/api/recordings/${encodeURIComponent(id)}/motion?poses=${poses}`;
    const answer = await this.ask(path);
    return unbroken(answer.arrayBuffer());
  }

  /** A tile of the matrix; null where the server has none. */
  tile(id: string, level: number, row: number, column: number): Promise<Blob | null> {
    const path = `/api/recordings/${encodeURIComponent(id)}/matrix/${level}/${row}/${column}`;
    return orNull(this.ask(path).then((answer) => unbroken(answer.blob())));
  }

  curves(id: string): Promise<CurveList> {
    return this.json(`/api/recordings/${encodeURIComponent(id)}/curves`);
  }

  /** Part of a curve; null where the server has none. */
  piece(id: string, curve: number, level: number, number: number): Promise<ArrayBuffer | null> {
    const path = `/api/recordings/${encodeURIComponent(id)}/curves/${curve}/${level}/${number}`;
    return orNull(this.ask(path).then((answer) => unbroken(answer.arrayBuffer())));
  }

  edit(id: string, request: EditRequest): Promise<Edited> {
    return this.json(`/api/recordings/${encodeURIComponent(id)}/edits`, request);
  }

  preview(id: string, request: PreviewRequest): Promise<Preview> {
    return this.json(`/api/recordings/${encodeURIComponent(id)}/preview`, request);
  }

  /** The tables that were replaced. */
  async versions(id: string): Promise<Version[]> {
    const address = `/api/recordings/${encodeURIComponent(id)}/versions`;
    return (await this.json<Versions>(address)).versions;
  }

  version(id: string, number: number): Promise<Comparison> {
    return this.json(`/api/recordings/${encodeURIComponent(id)}/versions/${number}`);
  }

  compare(id: string, request: CompareRequest): Promise<Comparison> {
    return this.json(`/api/recordings/${encodeURIComponent(id)}/compare`, request);
  }

  /** The segments of a level, or of all that the format holds, as a file named by the server. */
  exported(id: string, format: string, level: Level | ""): Promise<Download> {
    const path = `/api/recordings/${encodeURIComponent(id)}/export/${encodeURIComponent(format)}`;
    return this.download(`${path}?level=${level}`);
  }

  /** The same of all recordings that are checked. */
  exportedTogether(format: string, level: Level | ""): Promise<Download> {
    return this.download(`/api/export/${encodeURIComponent(format)}?level=${level}`);
  }

  /** Some rows of the table as motion files. */
  clips(id: string, request: ClipsRequest): Promise<Download> {
    return this.download(`/api/recordings/${encodeURIComponent(id)}/clips`, request);
  }

  shareLabels(request: LabelsRequest): Promise<string[]> {
    return this.json("/api/labels", request);
  }

  makeKnowledge(request: KnowledgeRequest): Promise<FileChoice> {
    return this.json("/api/knowledge", request);
  }

  /** How a recording is read from now on. */
  readAs(id: string, request: ReadingRequest): Promise<unknown> {
    return this.json(`/api/recordings/${encodeURIComponent(id)}/reading`, request);
  }

  /** The people in a recording, where one of them was chosen. */
  people(id: string): Promise<string[]> {
    return this.json(`/api/recordings/${encodeURIComponent(id)}/people`);
  }

  /** Where the video of a recording comes from. */
  videoAddress(id: string): string {
    const path = `/api/recordings/${encodeURIComponent(id)}/video`;
    return `${path}?token=${encodeURIComponent(this.token)}`;
  }

  placeVideo(id: string, request: VideoRequest): Promise<VideoRequest> {
    return this.json(`/api/recordings/${encodeURIComponent(id)}/video`, request);
  }

  /** A file into the folder; `progress` is told the share sent, 0 to 1. */
  upload(file: File, progress: (share: number) => void): Promise<Listing> {
    return new Promise((resolve, reject) => {
      const request = new XMLHttpRequest(); // fetch cannot tell how much is sent
      request.open("POST", `/api/recordings?name=${encodeURIComponent(file.name)}`);
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

  /** Calls back for every change, and when the line drops or returns; it is set up again by itself. */
  listen(changed: (change: Changed) => void, line: (up: boolean) => void, up = true): void {
    const source = new EventSource(`/api/events?token=${encodeURIComponent(this.token)}`);
    source.onmessage = (event) => changed(JSON.parse(event.data as string) as Changed);
    source.onopen = () => {
      if (!up) line(true);
      up = true;
    };
    source.onerror = () => {
      source.close();
      if (up) line(false);
      setTimeout(() => this.listen(changed, line, false), RETRY);
    };
  }

  private async download(path: string, body?: unknown): Promise<Download> {
    const answer = await this.ask(path, body);
    const name = filename(answer.headers.get("content-disposition") ?? "") || "kineme";
    return { name, data: await unbroken(answer.blob()) };
  }

  protected async json<T>(path: string, body?: unknown): Promise<T> {
    const answer = await this.ask(path, body);
    return (await unbroken(answer.json())) as T;
  }

  private async ask(path: string, body?: unknown): Promise<Response> {
    const headers: Record<string, string> = { "X-Kineme-Token": this.token };
    if (body !== undefined) headers["Content-Type"] = "application/json";
    const answer = await unbroken(
      fetch(path, {
        method: body === undefined ? "GET" : "POST",
        headers,
        body: body === undefined ? null : JSON.stringify(body),
        cache: "no-store",
      }),
    );
    if (answer.ok) return answer;
    const said = parsed(await unbroken(answer.text()));
    throw new Refused(answer.status, sentence(said, answer.status), said);
  }
}
