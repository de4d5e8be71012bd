/** Build addresses of the server; read and write the page's address. */
import type { OpenRecording } from "../../recordingData";
import type { GetPath, PostPath } from "./paths";

/** Names in braces of a path. */
type NameIn<P> = P extends `${string}{${infer Name}}${infer Rest}` ? Name | NameIn<Rest> : never;

/** Values for these names. */
export type PathParts<P> = Record<NameIn<P>, string | number>;

export type Query = Record<string, string | number>;

/** Build an address of the server. */
export function buildAddress<P extends GetPath | PostPath>(
  path: P,
  parts: PathParts<P>,
  query: Query = {},
): string {
  const filled = Object.entries<string | number>(parts).reduce<string>(
    (address, [name, part]) => address.replace(`{${name}}`, () => encodeURIComponent(part)),
    path,
  );
  return filled + buildQuery(query);
}

/** Build a page's address; without a recording it is the library's. */
export function buildPageAddress(token: string, open?: string, at_s = 0): string {
  return buildQuery({ token, ...(open && { open }), ...(at_s && { at: at_s.toFixed(3) }) });
}

/** Build the address that shows a library's recordings as a folder. */
export function buildFolderAddress(token: string): string {
  return buildQuery({ token, folder: 1 });
}

/** Return the token in this page's address. */
export function readToken(): string {
  return readQuery().get("token") ?? "";
}

export function writeToken(token: string): void {
  const address = readQuery();
  address.set("token", token);
  history.replaceState(null, "", `?${address}`);
}

/** Return the ids of open recordings in the address, which a reload restores. */
export function readOpenIds(): string[] {
  return readQuery().getAll("open");
}

/** Return the initial playhead in seconds. */
export function readStartTime(): number {
  return Number(readQuery().get("at")) || 0;
}

export function writeOpenIds(opened: OpenRecording[]): void {
  const address = readQuery();
  address.delete("open");
  address.delete("at");
  for (const each of opened) address.append("open", each.recording.peek().id);
  history.replaceState(null, "", `?${address}`);
}

function readQuery(): URLSearchParams {
  return new URLSearchParams(location.search);
}

function buildQuery(query: Query): string {
  const entries = Object.entries(query).map(([name, value]) => [name, String(value)]);
  return entries.length ? `?${new URLSearchParams(entries)}` : "";
}
