/** Identify, count, sort and export search hits. Pure functions. */
import type { LibraryCluster, LibraryHit } from "../../messages";

/** Return a key that identifies a hit's span. */
export function getHitKey(hit: LibraryHit): string {
  return JSON.stringify([hit.recording, hit.start_s, hit.stop_s]);
}

/** Count hits per cluster, most first; -1 is no cluster. */
export function countByCluster(hits: readonly LibraryHit[]): [cluster: number, hits: number][] {
  const counts = new Map<number, number>();
  for (const { cluster } of hits) counts.set(cluster, (counts.get(cluster) ?? 0) + 1);
  return [...counts].sort((a, b) => b[1] - a[1] || a[0] - b[0]);
}

export type Order = "seconds" | "count" | "name" | "unsure";

export function sortClusters(clusters: readonly LibraryCluster[], by: Order): LibraryCluster[] {
  const times = (each: LibraryCluster): number => each.repetitions || each.activities;
  const compare: Record<Order, (a: LibraryCluster, b: LibraryCluster) => number> = {
    seconds: (a, b) => b.seconds - a.seconds,
    count: (a, b) => times(b) - times(a),
    name: (a, b) =>
      Number(!a.label) - Number(!b.label) ||
      a.label.localeCompare(b.label) ||
      a.cluster - b.cluster,
    unsure: (a, b) => b.unsure - a.unsure,
  };
  return [...clusters].sort(compare[by]);
}

const COLUMNS = ["recording", "start_s", "stop_s", "distance", "cluster", "label", "name"] as const;

type Verdict = (hit: LibraryHit) => boolean | undefined;

/** Return hits and verdicts as JSON lines, as `kineme library search --json` does. */
export function toJson(hits: readonly LibraryHit[], verdict: Verdict): string {
  return hits
    .map((hit) => JSON.stringify({ ...hit, confirmed: verdict(hit) ?? null }) + "\n")
    .join("");
}

export function toCsv(hits: readonly LibraryHit[], verdict: Verdict): string {
  const cell = (value: string | number | boolean | null | undefined): string => {
    const text = String(value ?? "");
    return /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  };
  const rows = hits.map((hit) => [...COLUMNS.map((name) => hit[name]), verdict(hit)]);
  return [[...COLUMNS, "confirmed"], ...rows].map((row) => row.map(cell).join(",") + "\n").join("");
}

export function formatSeconds(value: number): string {
  const minutes = Math.floor(value / 60);
  return minutes
    ? `${minutes}:${(value % 60).toFixed(0).padStart(2, "0")} min`
    : `${value.toFixed(2)} s`;
}
