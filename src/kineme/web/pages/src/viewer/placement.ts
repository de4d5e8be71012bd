/** Compute where figures stand and which time they show. Pure functions. */
import type { Segment } from "../messages";
import { getHeading, computePose, findRoot, type Motion } from "../motion";

/** A figure and its placement. */
export interface PlacedFigure {
  motion: Motion;
  name: string;
  placement: Placement;
  /** The member of a cluster that it shows; null: it follows the playhead. */
  segment: Segment | null;
}

/**
 * How a figure is moved: `turn` (radians about y) and `from` (x, z) bring its first pose to `slot`.
 * With `isFixed` it stays on its slot in every pose.
 */
export interface Placement {
  slot: [number, number];
  from: [number, number];
  turn: number;
  isFixed: boolean;
}

/** Maximum number of members shown at once. */
export const MAX_MEMBERS = 24;

const UNMOVED: Placement = { slot: [0, 0], from: [0, 0], turn: 0, isFixed: false };

interface Shown {
  motion: Motion;
  name: string;
  /** Figures of the same file share a space; without a file each has its own. */
  file?: string | undefined;
}

/** Place several recordings side by side; one figure or people of one file stay in place. */
export function placeSideBySide(figures: readonly Shown[], size: number): PlacedFigure[] {
  const spaces = new Map<string | number, Shown[]>();
  figures.forEach((each, i) => {
    const space = each.file || i;
    spaces.set(space, [...(spaces.get(space) ?? []), each]);
  });
  const placed = new Map<Shown, Placement>();
  const widths = [...spaces.values()].map((people) => 0.95 * size + measureExtent(people)[2]);
  let left = -widths.reduce((sum, width) => sum + width, 0) / 2;
  [...spaces.values()].forEach((people, i) => {
    const x = left + widths[i]! / 2;
    left += widths[i]!;
    const [middleX, middleZ] = measureExtent(people);
    const slot: Placement = { ...UNMOVED, slot: [x, 0], from: [middleX, middleZ] };
    for (const each of people)
      placed.set(each, spaces.size === 1 ? UNMOVED : { ...slot, isFixed: people.length === 1 });
  });
  return figures.map((each) => ({
    motion: each.motion,
    name: each.name,
    placement: placed.get(each)!,
    segment: null,
  }));
}

/** Return whether a figure stays where it was recorded. */
export function isFree({ placement }: PlacedFigure): boolean {
  return placement === UNMOVED;
}

/** Return the centre (x, z) of several people at the start, and their extent along x. */
function measureExtent(people: readonly Shown[]): [number, number, number] {
  if (people.length < 2) return [0, 0, 0];
  const places = people.map(({ motion }) => {
    const pose = new Float32Array(motion.head.joints.length * 3);
    computePose(motion, 0, pose);
    const root = 3 * findRoot(motion.head);
    return [pose[root] || 0, pose[root + 2] || 0] as const;
  });
  const [xs, zs] = [places.map(([x]) => x), places.map(([, z]) => z)];
  const [low, high] = [Math.min(...xs), Math.max(...xs)];
  return [(low + high) / 2, (Math.min(...zs) + Math.max(...zs)) / 2, high - low];
}

/** Place the members of a cluster in rows, all facing the same way at their start. */
export function placeInStep(
  motion: Motion,
  members: readonly Segment[],
  size: number,
): PlacedFigure[] {
  const shown = members.slice(0, MAX_MEMBERS);
  const columns = Math.ceil(Math.sqrt(shown.length * 1.7));
  const rows = Math.ceil(shown.length / columns);
  const pose = new Float32Array(motion.head.joints.length * 3);
  const root = findRoot(motion.head);
  return shown.map((segment, i) => {
    computePose(motion, segment.start_s, pose);
    const row = Math.floor(i / columns);
    const inRow = row === rows - 1 ? shown.length - row * columns : columns;
    const x = ((i % columns) - (inRow - 1) / 2) * 0.85 * size;
    const z = ((rows - 1) / 2 - row) * 1.05 * size;
    const placement: Placement = {
      slot: [x, z],
      from: [pose[3 * root] || 0, pose[3 * root + 2] || 0],
      turn: -getHeading(motion, segment.start_s),
      isFixed: false,
    };
    return { motion, name: "", placement, segment };
  });
}

/**
 * Return the time in seconds that a figure shows. Members of a cluster show the same share of their
 * repetition as the leader: the member at the playhead, else the selected one.
 */
export function getFigureTime(
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

/** Apply a placement to a pose in place. */
export function movePose(pose: Float32Array, place: Placement, root: number): void {
  if (place === UNMOVED) return;
  const cos = Math.cos(place.turn);
  const sin = Math.sin(place.turn);
  const x0 = place.isFixed ? pose[3 * root]! || 0 : place.from[0];
  const z0 = place.isFixed ? pose[3 * root + 2]! || 0 : place.from[1];
  for (let i = 0; i < pose.length; i += 3) {
    const x = pose[i]! - x0;
    const z = pose[i + 2]! - z0;
    pose[i] = place.slot[0] + x * cos + z * sin;
    pose[i + 2] = place.slot[1] - x * sin + z * cos;
  }
}
