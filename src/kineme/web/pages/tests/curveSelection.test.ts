import { beforeAll, expect, test, vi } from "vitest";
import type { CurveList } from "../src/messages";
import { head } from "./recordings";

const joints = ["hips", "lfoot", "rfoot", "lwrist", "lhand", "rwrist", "rhand"];
const list: CurveList = {
  curves: ["height", "speed"].flatMap((group) =>
    joints.map((name) => ({ name, group, unit: "m" })),
  ),
  factor: 4,
  tile: 1024,
  levels: 1,
};
let chosen: typeof import("../src/panels/Channels");

beforeAll(async () => {
  vi.stubGlobal("localStorage", { getItem: () => null, setItem: () => undefined });
  chosen = await import("../src/panels/Channels");
});

test("before anybody chose, both hands and both feet are shown", () => {
  const effectors = { left_ankle: 1, right_ankle: 2, left_wrist: 3, right_wrist: 5, pelvis: 0 };
  const ends = chosen.getDefaultJoints(head(1, { joints, effectors }));
  const shown = chosen.selectCurves(list, ends).map(({ head }) => `${head.group} ${head.name}`);
  expect(shown).toEqual(["height lfoot", "height rfoot", "height lwrist", "height rwrist"]);
});

test("what is chosen is shown from then on, whatever was first", () => {
  chosen.toggleCurve(list, ["lfoot"], list.curves[joints.length]!);
  expect(chosen.selectCurves(list, []).map(({ curve }) => curve)).toEqual([1, joints.length]);
});
