import { deflateSync } from "node:zlib";
import { expect, test } from "vitest";
import { decodeMotion, getHeading, computePose, unpackMotion } from "../src/motion";
import { head, motion } from "./recordings";

/** Columns as `kineme.web.display` sends them: differences that wrap at 16 bits. */
function encode(samples: number[][]): ArrayBuffer {
  const columns = samples[0]!.map((_, c) => samples.map((row) => row[c]!));
  const differences = columns.flatMap((column) =>
    column.map((value, i) => value - (i ? column[i - 1]! : 0)),
  );
  return Int16Array.from(differences).buffer;
}

const samples = [
  [0, 1000, 0, 100, 1200, -5],
  [10, 1000, 0, 32000, 1200, -5],
  [20, 1000, 0, -32000, -32768, -5],
];

test("columns of differences become values, also over the edge of 16 bits", () => {
  expect([...decodeMotion(head(3), encode(samples)).steps]).toEqual(samples.flat());
});

test("a deflated message is unpacked", async () => {
  const packed = deflateSync(new Uint8Array(encode(samples)));
  const { steps } = await unpackMotion(head(3), new Uint8Array(packed).buffer);
  expect([...steps]).toEqual(samples.flat());
});

test("a message of another length is refused", () => {
  expect(() => decodeMotion(head(4), encode(samples))).toThrow("36 bytes, not 48");
});

test("poses lie between samples, in metres from the origin", () => {
  const walk = motion(3, (i) => [100 * i, 0, 0], { origin: [1, 2, 3] });
  const pose = new Float32Array(6);
  computePose(walk, 0.05, pose);
  expect(pose[0]).toBeCloseTo(1.05);
  expect(pose[1]).toBeCloseTo(2);
  computePose(walk, 99, pose);
  expect(pose[0]).toBeCloseTo(1.2);
  computePose(walk, -1, pose);
  expect(pose[0]).toBeCloseTo(1);
});

test("what was not seen is NaN, also half-way to it", () => {
  const gone = motion(2, (i, joint) => (i === 1 && joint === 1 ? [-32768, 0, 0] : [0, 0, 0]));
  const pose = new Float32Array(6);
  computePose(gone, 0.05, pose);
  expect(pose[3]).toBeNaN();
  expect(pose[0]).toBe(0);
});

test("the heading is that of the nearest sample, 0 where none is known", () => {
  expect(
    getHeading(
      motion(3, () => [0, 0, 0], { heading: [0, 1, 2] }),
      0.11,
    ),
  ).toBe(1);
  expect(
    getHeading(
      motion(3, () => [0, 0, 0]),
      0.1,
    ),
  ).toBe(0);
});
