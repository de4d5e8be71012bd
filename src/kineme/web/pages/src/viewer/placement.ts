/** Which figures are shown, where, and at which time of which recording. Pure functions. */
import type { Segment } from "../messages";
import { headingAt, poseAt, rootOf, type Motion } from "../motion";

/** A figure and where it stands. */
export interface PlacedFigure {
  motion: Motion;
  name: string;
  place: Place;
  /** The member of a cluster it shows; null: it follows the playhead. */
  segment: Segment | null;
}

/**
 * Where a figure goes. `still`: it stays on its slot; else it moves about from there.
 * `turn` (radians about y) and `from` (x, z) bring its first pose to the slot.
 */
export interface Place {
  slot: [number, number];
  from: [number, number];
  turn: number;
  still: boolean;
}

/** Most members of a cluster that are shown at once. */
export const MOST_MEMBERS = 24;

const FREE: Place = { slot: [0, 0], from: [0, 0], turn: 0, still: false };

interface Shown {
  motion: Motion;
  name: string;
  /** Those of the same file share their space; none: of a space of its own. */
  file?: string | undefined;
}

/**
 * One figure moves freely, and so do the people of one file, as they did. Several recordings stand
 * side by side: each on its slot, people of one file around theirs.
 */
export function sideBySide(figures: readonly Shown[], size: number): PlacedFigure[] {
  const spaces = new Map<string | number, Shown[]>();
  figures.forEach((each, i) => {
    const space = each.file || i;
    spaces.set(space, [...(spaces.get(space) ?? []), each]);
  });
  const placed = new Map<Shown, Place>();
  const widths = [...spaces.values()].map((people) => 0.95 * size + extentOf(people)[2]);
  let left = -widths.reduce((sum, width) => sum + width, 0) / 2;
  [...spaces.values()].forEach((people, i) => {
    const x = left + widths[i]! / 2;
    left += widths[i]!;
    const [middleX, middleZ] = extentOf(people);
    const slot: Place = { ...FREE, slot: [x, 0], from: [middleX, middleZ] };
    for (const each of people)
      placed.set(each, spaces.size === 1 ? FREE : { ...slot, still: people.length === 1 });
  });
  return figures.map((each) => ({
    motion: each.motion,
    name: each.name,
    place: placed.get(each)!,
    segment: null,
  }));
}

/** Whether a figure goes where it went. */
export function isFree({ place }: PlacedFigure): boolean {
  return place === FREE;
}

/** Where several people are when they begin: the middle (x, z), and how wide apart along x. */
function extentOf(people: readonly Shown[]): [number, number, number] {
  if (people.length < 2) return [0, 0, 0];
  const places = people.map(({ motion }) => {
    const pose = new Float32Array(motion.head.joints.length * 3);
    poseAt(motion, 0, pose);
    const root = 3 * rootOf(motion.head);
    return [pose[root] || 0, pose[root + 2] || 0] as const;
  });
  const [xs, zs] = [places.map(([x]) => x), places.map(([, z]) => z)];
  const [low, high] = [Math.min(...xs), Math.max(...xs)];
  return [(low + high) / 2, (Math.min(...zs) + Math.max(...zs)) / 2, high - low];
}

/** The members of a cluster in rows, all facing the same way where they begin. */
export function inStep(motion: Motion, members: readonly Segment[], size: number): PlacedFigure[] {
  const shown = members.slice(0, MOST_MEMBERS);
  const columns = Math.ceil(Math.sqrt(shown.length * 1.7));
  const rows = Math.ceil(shown.length / columns);
  const pose = new Float32Array(motion.head.joints.length * 3);
  const root = rootOf(motion.head);
  return shown.map((segment, i) => {
    poseAt(motion, segment.start_s, pose);
    const row = Math.floor(i / columns);
    const inRow = row === rows - 1 ? shown.length - row * columns : columns;
    const x = ((i % columns) - (inRow - 1) / 2) * 0.85 * size;
    const z = ((rows - 1) / 2 - row) * 1.05 * size;
    const place: Place = {
      slot: [x, z],
      from: [pose[3 * root] || 0, pose[3 * root + 2] || 0],
      turn: -headingAt(motion, segment.start_s),
      still: false,
    };
    return { motion, name: "", place, segment };
  });
}

/**
 * Which time (seconds) a figure shows. Members of a cluster keep step: all have done the same
 * share of their repetition as the one under the playhead, or else as the selected one.
 */
export function timeOf(
  figure: PlacedFigure,
  playhead: number,
  leader: Segment | undefined,
): number {
  const { segment } = figure;
  if (!segment) return playhead;
  const share = leader ? (playhead - leader.start_s) / (leader.stop_s - leader.start_s) : 0;
  const inside = Math.min(Math.max(share, 0), 1);
  return segment.start_s + inside * (segment.stop_s - segment.start_s);
}

/** Moves a pose to its place, in place. */
export function putInPlace(pose: Float32Array, place: Place, root: number): void {
  if (place === FREE) return;
  const cos = Math.cos(place.turn);
  const sin = Math.sin(place.turn);
  const x0 = place.still ? pose[3 * root]! || 0 : place.from[0];
  const z0 = place.still ? pose[3 * root + 2]! || 0 : place.from[1];
  for (let i = 0; i < pose.length; i += 3) {
    const x = pose[i]! - x0;
    const z = pose[i + 2]! - z0;
    pose[i] = place.slot[0] + x * cos + z * sin;
    pose[i + 2] = place.slot[1] - x * sin + z * cos;
  }
}
