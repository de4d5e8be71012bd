import { expect, test } from "vitest";
import { computeLoopPose, getRoundDuration } from "../src/viewer/placement";
import { motion } from "./recordings";

// One joint that goes a metre along z in a round of four frames; then a quarter turn.
const walk = motion(5, (i) => [0, 1000, 250 * i]);
const quarter = { motion: walk, step: { turn: Math.PI / 2, x: 0, z: 1 } };

function computePosition(seconds: number): number[] {
  const pose = new Float32Array(3 * walk.head.joints.length);
  computeLoopPose(quarter, seconds, pose);
  return [pose[0]!, pose[2]!];
}

test("each round begins where the one before ended, and continues with the same step", () => {
  const lasts = getRoundDuration(quarter);
  const corners = [0, 1, 2, 3, 4].map((round) => computePosition(round * lasts + 1e-9));
  const square = [
    [0, 0],
    [0, 1],
    [1, 1],
    [1, 0],
    [0, 0],
  ];
  corners.flat().forEach((value, i) => expect(value).toBeCloseTo(square.flat()[i]!, 3));
  for (const round of [1, 2, 3]) {
    const [before, after] = [
      computePosition(round * lasts - 1e-6),
      computePosition(round * lasts + 1e-6),
    ];
    before.forEach((value, axis) => expect(value).toBeCloseTo(after[axis]!, 3));
  }
});
