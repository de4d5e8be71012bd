/** A loop played round after round, each carried on from the one before. Pure functions. */
import type { PlayedLoop } from "../messages";
import { poseAt, unpackMotion, type Motion } from "../motion";
import { bytesOf } from "../recordingData";
import { putInPlace, type Place } from "./placement";

/** One round, its first pose again at the end, and what brings it to where the next begins. */
export interface Loop {
  motion: Motion;
  carry: Pick<PlayedLoop, "turn" | "x" | "z">;
}

export async function unpackLoop({ motion, numbers, ...carry }: PlayedLoop): Promise<Loop> {
  return { motion: await unpackMotion(motion, bytesOf(numbers).buffer), carry };
}

/** How long a round is, seconds. */
export function secondsOfRound({ motion: { head } }: Loop): number {
  return Math.max(head.n_samples - 1, 1) / head.sample_fps;
}

/** The pose so many seconds after the first round began goes into `out`, as `poseAt` has it. */
export function loopPoseAt(loop: Loop, seconds: number, out: Float32Array): void {
  const lasts = secondsOfRound(loop);
  const round = Math.floor(seconds / lasts);
  poseAt(loop.motion, seconds - round * lasts, out);
  putInPlace(out, placeOf(loop, round), 0);
}

/** Where a round is, the first being where it was recorded. */
function placeOf({ carry }: Loop, round: number): Place {
  const [cos, sin] = [Math.cos(carry.turn), Math.sin(carry.turn)];
  let [x, z] = [0, 0];
  for (let each = 0; each < round; each++)
    [x, z] = [x * cos + z * sin + carry.x, z * cos - x * sin + carry.z];
  return { slot: [x, z], from: [0, 0], turn: round * carry.turn, still: false };
}
