/**
 * Send all requests of the studio. A request ends in its answer, in `Refused` (the server explains
 * why) or in `Unreachable` (no answer; it may have been carried out). Nothing else is thrown.
 */
import type * as messages from "../../messages";
import type { RecordingData } from "../../recordingData";
import { formatCount } from "../../util";
import { buildAddress, writeToken, type PathParts, type Query } from "./address";
import type { GetPath, PostPath } from "./paths";

/** Milliseconds between attempts to reach the server. */
export const RETRY_INTERVAL = 1000;

const readBytes = (answer: Response): Promise<ArrayBuffer> => answer.arrayBuffer();

export class Api {
  /** @param token from the address that the server printed; each server has its own */
  constructor(public token: string) {}

  // The folder.
  loadState = (): Promise<messages.State> => this.get("/api/state", {});
  /** Return the tables of all recordings of the folder. */
  loadTables = (): Promise<messages.FolderTables> => this.get("/api/tables", {});
  shareLabels = (request: messages.LabelsRequest): Promise<string[]> =>
    this.post("/api/labels", {}, request);
  makeKnowledge = (request: messages.KnowledgeRequest): Promise<messages.FileChoice> =>
    this.post("/api/knowledge", {}, request);

  // A recording and its table.
  loadRecording = (id: string): Promise<messages.Recording> =>
    this.get("/api/recordings/{id}", { id });
  sendEdit = (id: string, request: messages.EditRequest): Promise<messages.Edited> =>
    this.post("/api/recordings/{id}/edits", { id }, request);
  loadPreview = (id: string, request: messages.PreviewRequest): Promise<messages.Preview> =>
    this.post("/api/recordings/{id}/preview", { id }, request);
  /** Change how a file is read; return the ids of the resulting recordings. */
  readAs = (id: string, request: messages.ReadRequest): Promise<string[]> =>
    this.post("/api/recordings/{id}/reading", { id }, request);
  placeVideo = (id: string, request: messages.VideoRequest): Promise<messages.VideoRequest> =>
    this.post("/api/recordings/{id}/video", { id }, request);
  /** Return the progress of the computation for a recording. */
  loadProgress = (id: string): Promise<messages.Progress> =>
    this.get("/api/recordings/{id}/progress", { id });
  /** Cancel the computation for a recording. */
  cancel = (id: string): Promise<unknown> =>
    this.request(buildAddress("/api/recordings/{id}/cancel", { id }), readBytes, {});
  /** Return the replaced tables. */
  loadVersions = (id: string): Promise<messages.Versions> =>
    this.get("/api/recordings/{id}/versions", { id });
  loadVersion = (id: string, number: number): Promise<messages.Comparison> =>
    this.get("/api/recordings/{id}/versions/{number}", { id, number });

  // Comparisons.
  compare = (id: string, request: messages.CompareRequest): Promise<messages.Comparison> =>
    this.post("/api/recordings/{id}/compare", { id }, request);
  /** Return who labelled recordings of the folder. */
  loadAnnotators = (): Promise<messages.AnnotatorChoice[]> => this.get("/api/annotators", {});
  /** Return how well people agree over the folder. */
  loadAgreement = (request: messages.AgreementRequest): Promise<messages.Agreement> =>
    this.post("/api/agreement", {}, request);
  /** Return their labels of a recording. */
  loadLanes = (id: string, request: messages.AgreementRequest): Promise<messages.LabelLane[]> =>
    this.post("/api/recordings/{id}/lanes", { id }, request);

  // Files to save. Without a level, all levels that the format holds are exported.
  exportSegments = (id: string, format: string, level: messages.Level | ""): Promise<Download> =>
    this.download(buildAddress("/api/recordings/{id}/export/{format}", { id, format }, { level }));
  /** Export all checked recordings. */
  exportAll = (format: string, level: messages.Level | ""): Promise<Download> =>
    this.download(buildAddress("/api/export/{format}", { format }, { level }));
  /** Export rows of the table as motion files. */
  exportClips = (id: string, request: messages.ClipsRequest): Promise<Download> =>
    this.download(buildAddress("/api/recordings/{id}/clips", { id }), request);
  /** Return the quality of the repetitions as loops. */
  loadLoops = (id: string): Promise<messages.Loops> =>
    this.get("/api/recordings/{id}/loops", { id });
  /** Return one round of the loop made from a row of the table. */
  loadLoop = (id: string, number: number): Promise<messages.PlayedLoop> =>
    this.get("/api/recordings/{id}/loops/{number}", { id, number });

  // Estimation of poses.
  loadPosesProgress = (): Promise<messages.PosesProgress> => this.get("/api/poses", {});
  estimatePoses = (request: messages.PosesRequest): Promise<messages.PosesProgress> =>
    this.post("/api/poses", {}, request);
  cancelPoses = (): Promise<unknown> =>
    this.request(buildAddress("/api/poses/cancel", {}), readBytes, {});

  // A library.
  loadLibrary = (): Promise<messages.LibraryState> => this.get("/api/library", {});
  editLibrary = (edit: messages.LibraryEdit): Promise<messages.LibraryState> =>
    this.post("/api/library/edits", {}, edit);
  /** Write the library's numbers and names to saved tables. */
  updateTables = (request: messages.TablesRequest): Promise<messages.TablesChanged> =>
    this.post("/api/library/tables", {}, request);
  nameHits = (request: messages.CallHits): Promise<messages.NamedHits> =>
    this.post("/api/library/names", {}, request);
  /** Search; refused with status 409 if a newer search was sent meanwhile. */
  search = (request: messages.SearchRequest): Promise<messages.LibraryHits> =>
    this.post("/api/library/search", {}, request);
  loadFigure = ({ recording, start_s, stop_s }: messages.Span): Promise<messages.LibraryFigure> =>
    this.get("/api/library/figure", {}, { recording, start: start_s, stop: stop_s });
  /** Rename a cluster in all recordings: by the library's number, or by its previous name. */
  renameEverywhere = (
    request: messages.CallEverywhere,
    ofLibrary: boolean,
  ): Promise<messages.TablesChanged> =>
    this.post(ofLibrary ? "/api/library/everywhere" : "/api/names", {}, request);

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
        const { status, responseText } = request;
        if (status < 300) resolve(JSON.parse(responseText) as messages.Listing);
        else reject(createRefusal(status, responseText));
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

  get<T, P extends GetPath>(path: P, parts: PathParts<P>, query?: Query): Promise<T> {
    return this.request<T>(buildAddress(path, parts, query), (answer) => answer.json());
  }

  private post<T, P extends PostPath>(path: P, parts: PathParts<P>, request: unknown): Promise<T> {
    return this.request<T>(buildAddress(path, parts), (answer) => answer.json(), request);
  }

  private download(address: string, body?: unknown): Promise<Download> {
    const read = async (answer: Response): Promise<Download> => {
      const name = parseFilename(answer.headers.get("content-disposition") ?? "") || "kineme";
      return { name, data: await answer.blob() };
    };
    return this.request(address, read, body);
  }

  /** Send a request, with a body as POST, and return what `read` reads of the answer. */
  async request<T>(
    address: string,
    read: (answer: Response) => Promise<T>,
    body?: unknown,
  ): Promise<T> {
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
    if (answer.ok) return catchNetworkError(read(answer));
    throw createRefusal(answer.status, await catchNetworkError(answer.text()));
  }
}

/** Load the data of one recording from the studio's server. */
export class ServerData implements RecordingData {
  private channels: Promise<messages.CycleChannel[]> | null = null;

  constructor(
    private readonly api: Api,
    private readonly id: string,
  ) {}

  loadMotion(poses: number): Promise<ArrayBuffer> {
    const address = buildAddress("/api/recordings/{id}/motion", { id: this.id }, { poses });
    return this.api.request(address, readBytes);
  }

  loadKeypoints(): Promise<ArrayBuffer> {
    return this.api.request(
      buildAddress("/api/recordings/{id}/keypoints", { id: this.id }),
      readBytes,
    );
  }

  getVideoAddresses(): string[] {
    const { token } = this.api;
    return [buildAddress("/api/recordings/{id}/video", { id: this.id }, { token })];
  }

  loadTile(level: number, row: number, column: number): Promise<Blob | null> {
    const path = "/api/recordings/{id}/matrix/{level}/{row}/{column}";
    const address = buildAddress(path, { id: this.id, level, row, column });
    return nullIfMissing(this.api.request(address, (answer) => answer.blob()));
  }

  loadCurves(): Promise<messages.CurveList> {
    return this.api.get("/api/recordings/{id}/curves", { id: this.id });
  }

  loadCurveTile(curve: number, level: number, number: number): Promise<ArrayBuffer | null> {
    const path = "/api/recordings/{id}/curves/{curve}/{level}/{number}";
    const address = buildAddress(path, { id: this.id, curve, level, number });
    return nullIfMissing(this.api.request(address, readBytes));
  }

  loadCycleChannels(): Promise<messages.CycleChannel[]> {
    const load = async (): Promise<messages.CycleChannel[]> => {
      const path = "/api/recordings/{id}/cycles";
      const answer: messages.CycleChannels = await this.api.get(path, { id: this.id });
      return answer.channels;
    };
    this.channels ??= load().catch((error: unknown) => {
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
  ): Promise<messages.ClusterCurves | null> {
    const path = "/api/recordings/{id}/cycles/{cluster}";
    const query = { channel, ...(beside && { beside }) };
    return nullIfMissing(
      this.api.get<messages.ClusterCurves, typeof path>(path, { id: this.id, cluster }, query),
    );
  }
}

/** A file to save. */
interface Download {
  name: string;
  data: Blob;
}

export class Refused extends Error {
  constructor(
    readonly status: number,
    message: string,
    readonly body: unknown,
  ) {
    super(message);
  }
}

export class Unreachable extends Error {
  constructor() {
    super("The studio's server does not answer.");
  }
}

/** Return the people to choose from if a recording could not be read, else null. */
export function getUnreadPeople(error: unknown): string[] | null {
  const failure =
    error instanceof Refused ? (error.body as Partial<messages.Failure> | null) : null;
  return failure?.reading ? (failure.people ?? []) : null;
}

/** Return whether a video's poses must be estimated first. */
export function needsPoses(error: unknown): boolean {
  return (
    error instanceof Refused && Boolean((error.body as Partial<messages.Failure> | null)?.poses)
  );
}

/** Return a message for anything that was thrown. */
export function explainError(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}

/** Describe what a change of saved tables left as it was; empty if nothing. */
export function describeUnchanged({ others, left }: messages.TablesChanged): string {
  const kept = others ? ` Another name stays with ${formatCount(others, "cluster")} there.` : "";
  return kept + (left.length ? ` Not changed: ${left.join("; ")}.` : "");
}

/** Return the file name of a Content-Disposition header, the UTF-8 form first; empty if none. */
function parseFilename(disposition: string): string {
  const encoded = /filename\*=utf-8''([^;]+)/i.exec(disposition)?.[1];
  if (encoded) return decodeURIComponent(encoded);
  return /filename="?([^";]+)"?/i.exec(disposition)?.[1] ?? "";
}

/** Return the answer, or null for status 404. */
async function nullIfMissing<T>(answer: Promise<T>): Promise<T | null> {
  try {
    return await answer;
  } catch (error) {
    if (error instanceof Refused && error.status === 404) return null;
    throw error;
  }
}

async function catchNetworkError<T>(work: Promise<T>): Promise<T> {
  try {
    return await work;
  } catch {
    throw new Unreachable();
  }
}

function createRefusal(status: number, text: string): Refused {
  let body: Partial<messages.Failure> | null = null;
  try {
    body = JSON.parse(text) as Partial<messages.Failure> | null;
  } catch {
    // It is not from kineme.
  }
  return new Refused(status, body?.error ?? `The server refused this with status ${status}.`, body);
}

/**
 * Send this tab's token to other tabs and take over theirs if its own is no longer valid. A
 * restarted server has a new token, known to the tab it opens. Older tabs, which may hold unsent
 * edits, continue with it.
 */
export function shareToken(api: Api): void {
  const channel = new BroadcastChannel("kineme.token");
  const isGood = (token: string): Promise<boolean> =>
    new Api(token)
      .loadState()
      .then(() => true)
      .catch((error: unknown) => !(error instanceof Refused));
  channel.onmessage = async ({ data: token }: MessageEvent<string>) => {
    if (token === api.token || (await isGood(api.token)) || !(await isGood(token))) return;
    api.token = token;
    writeToken(token);
  };
  channel.postMessage(api.token);
}

/** Save a file with the browser. */
export function saveFile({ name, data }: Download): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(data);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
