/** Compute where figures stand, which time they show and how thick they are. Pure functions. */
import type { MotionHead, PlayedLoop, Segment } from "../messages";
import {
  computePose,
  createPose,
  getHeading,
  getRootPosition,
  unpackMotion,
  type Motion,
} from "../motion";
import { groupBy, memoize } from "../util";
import { decodeBase64 } from "../recordingData";

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
  const spaces = [...groupBy(figures, ({ file }, i) => file || i).values()];
  const placed = new Map<Shown, Placement>();
  const extents = spaces.map(measureExtent);
  const widths = extents.map(([, , extent]) => 0.95 * size + extent);
  let left = -widths.reduce((sum, width) => sum + width, 0) / 2;
  spaces.forEach((people, i) => {
    const [x, z] = extents[i]!;
    const slot: Placement = { ...UNMOVED, slot: [left + widths[i]! / 2, 0], from: [x, z] };
    left += widths[i]!;
    for (const each of people)
      placed.set(each, spaces.length === 1 ? UNMOVED : { ...slot, isFixed: people.length === 1 });
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
  const places = people.map(({ motion }) => getRootPosition(motion, 0));
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
  return shown.map((segment, i) => {
    const row = Math.floor(i / columns);
    const inRow = row === rows - 1 ? shown.length - row * columns : columns;
    const x = ((i % columns) - (inRow - 1) / 2) * 0.85 * size;
    const z = ((rows - 1) / 2 - row) * 1.05 * size;
    const placement: Placement = {
      slot: [x, z],
      from: getRootPosition(motion, segment.start_s),
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

/** Radii in metres; a bone tapers from `bones[i]` to `TAPER` times that. */
export interface Anatomy {
  /** Height of the body, or the extent of the recorded part, metres. */
  size: number;
  /** Height of the ground, metres. */
  ground: number;
  bones: Float32Array;
  joints: Float32Array;
  /** Index of the bone drawn as a head; -1 if unknown. */
  skull: number;
}

export const TAPER = 0.62;

function measureAnatomy(motion: Motion): Anatomy {
  const { head } = motion;
  const pose = createPose(motion);
  const lowest: number[] = [];
  const extents: number[] = [];
  const lengths = head.bones.map(() => [] as number[]);
  const seconds = head.n_samples / head.sample_fps;
  for (let i = 0; i < 100; i++) {
    computePose(motion, (seconds * i) / 100, pose);
    const axes = [0, 1, 2].map((axis) =>
      pose.filter((value, k) => k % 3 === axis && !Number.isNaN(value)),
    );
    if (!axes[0]!.length) continue;
    lowest.push(Math.min(...axes[1]!));
    extents.push(Math.max(...axes.map((values) => Math.max(...values) - Math.min(...values))));
    head.bones.forEach(([a, b], bone) => {
      const apart = [0, 1, 2].map((axis) => pose[3 * a + axis]! - pose[3 * b + axis]!);
      const length = Math.hypot(...apart);
      if (Number.isFinite(length)) lengths[bone]!.push(length);
    });
  }
  const size = computeQuantile(extents, 0.5) || 1;
  const bones = computeBoneRadii(
    head,
    size,
    lengths.map((all) => computeQuantile(all, 0.5)),
  );
  const joints = computeJointRadii(head, size, bones);
  const skull = head.bones.findIndex(([, tip]) => tip === head.effectors["head"]);
  return { size, ground: computeQuantile(lowest, 0.05) - 0.008 * size, bones, joints, skull };
}

/** Return bone radii in metres: long bones are thick, fingers thin, the spine thickest. */
function computeBoneRadii(head: MotionHead, size: number, lengths: number[]): Float32Array {
  const spine = tracePathToRoot(head, head.effectors["head"] ?? -1);
  return Float32Array.from(lengths, (length, bone) => {
    const [from, to] = head.bones[bone]!;
    const share = 0.03 * Math.sqrt(length / (0.23 * size));
    const thick = spine.has(from) && spine.has(to) ? 1.5 : 1;
    return size * Math.min(Math.max(share * thick, 0.005), 0.036);
  });
}

/** Return joint radii in metres; a joint covers the ends of its bones. */
function computeJointRadii(head: MotionHead, size: number, bones: Float32Array): Float32Array {
  const radii = new Float32Array(head.joints.length);
  head.bones.forEach(([from, to], bone) => {
    radii[from] = Math.max(radii[from]!, 1.12 * bones[bone]!);
    radii[to] = Math.max(radii[to]!, 1.2 * TAPER * bones[bone]!);
  });
  const crown = head.effectors["head"] ?? -1;
  return radii.map((radius, joint) => {
    const inside = joint === crown && radius > 0; // hidden inside the head
    return inside ? 0 : radius || 0.011 * size;
  });
}

function tracePathToRoot(head: MotionHead, joint: number): Set<number> {
  const path = new Set<number>();
  for (let at = joint; at >= 0 && !path.has(at); at = head.parents[at] ?? -1) path.add(at);
  return path;
}

/** Return a quantile; 0 of no values. */
function computeQuantile(values: readonly number[], share: number): number {
  const sorted = [...values].sort((a, b) => a - b);
  return sorted[Math.min(Math.floor(share * sorted.length), sorted.length - 1)] ?? 0;
}

/** Return the cached anatomy of a motion. */
export const getAnatomy = memoize(measureAnatomy);

/** One round, ending with its first pose, and the displacement to the next round. */
export interface Loop {
  motion: Motion;
  step: Pick<PlayedLoop, "turn" | "x" | "z">;
}

export async function unpackLoop({ motion, numbers, ...step }: PlayedLoop): Promise<Loop> {
  return { motion: await unpackMotion(motion, decodeBase64(numbers).buffer), step };
}

/** Return the duration of a round in seconds. */
export function getRoundDuration({ motion: { head } }: Loop): number {
  return Math.max(head.n_samples - 1, 1) / head.sample_fps;
}

/** Write the pose at a time (seconds since the first round began) to `out`, like `computePose`. */
export function computeLoopPose(loop: Loop, seconds: number, out: Float32Array): void {
  const lasts = getRoundDuration(loop);
  const round = Math.floor(seconds / lasts);
  computePose(loop.motion, seconds - round * lasts, out);
  movePose(out, computeLoopPlacement(loop, round), 0);
}

/** Return a round's placement; the first is where it was recorded. */
function computeLoopPlacement({ step }: Loop, round: number): Placement {
  const [cos, sin] = [Math.cos(step.turn), Math.sin(step.turn)];
  let [x, z] = [0, 0];
  for (let each = 0; each < round; each++)
    [x, z] = [x * cos + z * sin + step.x, z * cos - x * sin + step.z];
  return { slot: [x, z], from: [0, 0], turn: round * step.turn, isFixed: false };
}
