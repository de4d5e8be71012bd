/** What segments are: their clusters and kinds, as `kineme/segments/editing/clusters.py` has it. */
import type { Kind, Level, Segment } from "../../../messages";
import { isCalledByCluster, namesIn, membersOf, withNames } from "./names";
import {
  allRows,
  eachRow,
  Impossible,
  joined,
  kindOf,
  starting,
  withRows,
  type Draft,
} from "./rows";

export function setCluster(draft: Draft, level: Level, frame: number, cluster: number): Draft {
  if (cluster < -1 || cluster > following(draft)) throw new Impossible();
  const chosen = starting(draft, level, frame);
  const inside = draft.primitive.filter(
    (row) => row.activity === chosen.activity && row.cluster === chosen.cluster,
  );
  const members = level === "activity" ? [chosen, ...inside] : [chosen];
  const rests = cluster < 0 && chosen.kind === "transition";
  return movedTo(draft, members, cluster, (row) => kindOf(row.level, rests));
}

export function mergeClusters(draft: Draft, cluster: number, into: number): Draft {
  const members = membersOf(draft, cluster);
  if (!members.length || !membersOf(draft, into).length || cluster === into) throw new Impossible();
  return movedTo(draft, members, into);
}

export function splitCluster(draft: Draft, cluster: number, frames: readonly number[]): Draft {
  const rows = membersOf(draft, cluster);
  const level = levelOf(rows);
  const divisible = rows.filter((row) => row.level === level);
  const leavers = divisible.filter((row) => frames.includes(row.start_frame));
  if (!leavers.length || leavers.length === divisible.length) throw new Impossible();
  const staying = new Set(
    divisible.filter((row) => !leavers.includes(row)).map((row) => row.activity),
  );
  const leaving = new Set(leavers.map((row) => row.activity).filter((each) => !staying.has(each)));
  const activities = draft.activity.filter((row, i) => leaving.has(i) && row.cluster === cluster);
  return movedTo(
    draft,
    level === "primitive" ? [...leavers, ...activities] : leavers,
    following(draft),
  );
}

/** The level on which a cluster is divided: that of primitives where it has any. */
export function levelOf(members: readonly Segment[]): Level {
  return members.some((row) => row.level === "primitive") ? "primitive" : "activity";
}

export function orderClusters(draft: Draft, order: readonly number[]): Draft {
  const clusters = new Set(allRows(draft).map((row) => row.cluster));
  clusters.delete(-1);
  const activities =
    order.length === clusters.size && order.every((cluster) => clusters.has(cluster));
  if (!activities || new Set(order).size !== clusters.size) throw new Impossible();
  const numbered = (cluster: number): number => order.indexOf(cluster);
  const names = [...namesIn(draft)].map(([id, name]) => [numbered(id), name] as const);
  const rows = eachRow(draft, (row) => ({ ...row, cluster: numbered(row.cluster) }));
  return withNames(rows, new Map(names));
}

export function setKind(draft: Draft, level: Level, frame: number, kind: Kind): Draft {
  const chosen = starting(draft, level, frame);
  const rests = kind === "transition";
  if (rests === (chosen.kind === "transition")) return draft;
  const become = (row: Segment): Segment => {
    const cluster = rests ? -1 : row.cluster;
    return { ...row, kind: kindOf(row.level, rests), cluster, confidence: null };
  };
  const { activity, primitive } = draft;
  if (level === "primitive") {
    const parts = primitive.map((row) => (row === chosen ? become(row) : row));
    return withRows(draft, activity, parts);
  }
  const inside = primitive.flatMap((row, i) => (row.activity === chosen.activity ? [i] : []));
  const one = inside.length > 0 && rests;
  const parts = one ? joined(primitive, inside[0]!, inside.at(-1)!, inside[0]!) : primitive;
  const changed = new Set(one ? inside.slice(0, 1) : inside);
  return withRows(
    draft,
    activity.map((row) => (row === chosen ? become(row) : row)),
    parts.map((row, i) => (changed.has(i) ? become(row) : row)),
  );
}

/** The number of the next new cluster. */
function following(draft: Draft): number {
  return allRows(draft).reduce((most, row) => Math.max(most, row.cluster), -1) + 1;
}

/** The members in another cluster, called by its name unless they have their own. */
function movedTo(
  draft: Draft,
  members: readonly Segment[],
  cluster: number,
  kind = (row: Segment): Kind => row.kind,
): Draft {
  const names = namesIn(draft);
  const chosen = new Set(members);
  const rows = eachRow(draft, (row) => {
    if (!chosen.has(row)) return row;
    const label = isCalledByCluster(row, names) ? (names.get(cluster) ?? "") : row.label;
    return { ...row, cluster, confidence: null, label, kind: kind(row) };
  });
  return withNames(rows, new Map([...(cluster >= 0 ? [[cluster, ""] as const] : []), ...names]));
}
