/** The open recordings in the address of the page. */
import type { OpenRecording } from "../../opened";

/** The recordings named in the address, so that a reload finds them, and the server ahead of it. */
export function fromAddress(): string[] {
  return new URLSearchParams(location.search).getAll("open");
}

/** Seconds at which the first of them is to be shown. */
export function momentInAddress(): number {
  return Number(new URLSearchParams(location.search).get("at")) || 0;
}

export function toAddress(opened: OpenRecording[]): void {
  const address = new URLSearchParams(location.search);
  address.delete("open");
  address.delete("at");
  for (const each of opened) address.append("open", each.recording.peek().id);
  history.replaceState(null, "", `?${address}`);
}
