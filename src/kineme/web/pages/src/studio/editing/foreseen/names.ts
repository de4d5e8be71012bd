/** What segments and clusters are called, as `kineme/segments/editing/naming.py` has it. */
import type { Level, Segment } from "../../../messages";
import { allRows, eachRow, Impossible, starting, type Draft } from "./rows";

export type Names = ReadonlyMap<number, string>;

export function nameSegment(draft: Draft, level: Level, frame: number, label: string): Draft {
  const row = starting(draft, level, frame);
  const names = namesIn(draft);
  const called = label || (names.get(row.cluster) ?? "");
  const named = eachRow(draft, (each) => (each === row ? { ...each, label: called } : each));
  return row.cluster < 0 ? named : withNames(named, new Map([[row.cluster, ""], ...names]));
}

export function nameCluster(draft: Draft, cluster: number, label: string): Draft {
  if (!membersOf(draft, cluster).length) throw new Impossible();
  const names = namesIn(draft);
  const named = eachRow(draft, (row) =>
    row.cluster === cluster && isCalledByCluster(row, names) ? { ...row, label } : row,
  );
  return withNames(named, new Map([...names, [cluster, label]]));
}

/** Whether a segment has no name of its own. */
export function isCalledByCluster(row: Segment, names: Names): boolean {
  return row.label === "" || row.label === (names.get(row.cluster) ?? "");
}

export function membersOf(draft: Draft, cluster: number): Segment[] {
  return cluster < 0 ? [] : allRows(draft).filter((row) => row.cluster === cluster);
}

/** The same segments, whose clusters have these names and no others; labels stay as they are. */
export function withNames(draft: Draft, names: Names): Draft {
  const clusters = new Set(allRows(draft).map((row) => row.cluster));
  const kept = [...names].filter(([cluster]) => clusters.has(cluster));
  const annotation = { ...draft.annotation, cluster_names: Object.fromEntries(kept) };
  return { ...draft, annotation };
}

/** The names of clusters by number; empty for those that are said to have none. */
export function namesIn(draft: Draft): Map<number, string> {
  const chosen = draft.annotation.cluster_names;
  const labels = new Map<number, Map<string, number>>();
  for (const { cluster, label } of allRows(draft)) {
    if (cluster < 0) continue;
    const counts = labels.get(cluster) ?? new Map<string, number>();
    labels.set(cluster, counts.set(label, (counts.get(label) ?? 0) + 1));
  }
  const names = new Map<number, string>();
  for (const cluster of [...labels.keys()].sort((a, b) => a - b)) {
    const counts = [...labels.get(cluster)!];
    const total = counts.reduce((sum, [, count]) => sum + count, 0);
    const most = counts.find(([label, count]) => label && 2 * count > total);
    const name = chosen[cluster] ?? most?.[0];
    if (name !== undefined) names.set(cluster, name);
  }
  return names;
}
