/** Addresses: those of the server, as it lists them, and that of a page, with what is open on it. */
import type { OpenRecording } from "../../opened";
import type { GetPath, PostPath } from "./paths";

/** The names in braces of a path. */
type NameIn<P> = P extends `${string}{${infer Name}}${infer Rest}` ? Name | NameIn<Rest> : never;

/** What is filled in for them. */
export type Parts<P> = Record<NameIn<P>, string | number>;

export type Query = Record<string, string | number>;

/** An address of the server. */
export function addressOf<P extends GetPath | PostPath>(
  path: P,
  parts: Parts<P>,
  query: Query = {},
): string {
  const filled = Object.entries<string | number>(parts).reduce<string>(
    (address, [name, part]) => address.replace(`{${name}}`, () => encodeURIComponent(part)),
    path,
  );
  return filled + search(query);
}

/** The address of a page; of the library where no recording is named. */
export function pageAddress(token: string, open?: string, at_s = 0): string {
  return search({ token, ...(open && { open }), ...(at_s && { at: at_s.toFixed(3) }) });
}

/** The address of the page that shows the recordings of a library as a folder. */
export function folderAddress(token: string): string {
  return search({ token, folder: 1 });
}

/** The token in this page's address. */
export function tokenInAddress(): string {
  return inAddress().get("token") ?? "";
}

export function tokenToAddress(token: string): void {
  const address = inAddress();
  address.set("token", token);
  history.replaceState(null, "", `?${address}`);
}

/** The recordings named in the address, so that a reload finds them, and the server ahead of it. */
export function openInAddress(): string[] {
  return inAddress().getAll("open");
}

/** Seconds at which the first of them is to be shown. */
export function secondsInAddress(): number {
  return Number(inAddress().get("at")) || 0;
}

export function openToAddress(opened: OpenRecording[]): void {
  const address = inAddress();
  address.delete("open");
  address.delete("at");
  for (const each of opened) address.append("open", each.recording.peek().id);
  history.replaceState(null, "", `?${address}`);
}

function inAddress(): URLSearchParams {
  return new URLSearchParams(location.search);
}

function search(query: Query): string {
  const entries = Object.entries(query).map(([name, value]) => [name, String(value)]);
  return entries.length ? `?${new URLSearchParams(entries)}` : "";
}
