/** Compute poses of a repeated loop; each round continues from the one before. Pure functions. */
import type { PlayedLoop } from "../messages";
import { computePose, unpackMotion, type Motion } from "../motion";
import { decodeBase64 } from "../recordingData";
import { movePose, type Placement } from "./placement";

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
  movePose(out, computePlacement(loop, round), 0);
}

/** Return a round's placement; the first is where it was recorded. */
function computePlacement({ step }: Loop, round: number): Placement {
  const [cos, sin] = [Math.cos(step.turn), Math.sin(step.turn)];
  let [x, z] = [0, 0];
  for (let each = 0; each < round; each++)
    [x, z] = [x * cos + z * sin + step.x, z * cos - x * sin + step.z];
  return { slot: [x, z], from: [0, 0], turn: round * step.turn, isFixed: false };
}
