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

/** One figure moves freely; several stand side by side, each on its slot. */
export function sideBySide(
  figures: readonly { motion: Motion; name: string }[],
  size: number,
): PlacedFigure[] {
  return figures.map(({ motion, name }, i) => {
    const x = (i - (figures.length - 1) / 2) * 0.95 * size;
    const place: Place = figures.length === 1 ? FREE : { ...FREE, slot: [x, 0], still: true };
    return { motion, name, place, segment: null };
  });
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
