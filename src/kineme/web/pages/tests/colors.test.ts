import { expect, test } from "vitest";
import {
  getClusterColor,
  getTextColor,
  assignLabelColors,
  computeLuminance,
  NO_COLOR,
  adaptColor,
} from "../src/colors";

test("colours are those of kineme._colors", () => {
  expect([-1, 0, 8, 9, 17, 18, 27].map(getClusterColor)).toEqual([
    "#DDDDDD",
    "#332288",
    "#AA4499",
    "#9990C4",
    "#D4A2CC",
    "#1F1452",
    "#332288",
  ]);
});

test("names can be read on every colour", () => {
  for (let cluster = -1; cluster < 27; cluster++) {
    const color = getClusterColor(cluster);
    const [dark, light] = [computeLuminance(color), computeLuminance(getTextColor(color))].sort(
      (a, b) => a - b,
    );
    expect((light! + 0.05) / (dark! + 0.05)).toBeGreaterThanOrEqual(4.5);
  }
});

test("the darkest colours become visible on a dark page, others stay", () => {
  expect(computeLuminance(adaptColor("#332288", "dark"))).toBeGreaterThan(0.1);
  expect(adaptColor("#88CCEE", "dark")).toBe("#88CCEE");
  expect(adaptColor("#332288", "light")).toBe("#332288");
});

test("a label has the colour of the cluster that has it most, else one of its own", () => {
  const row = (label: string, cluster: number, seconds = 1) => {
    return { label, cluster, start_s: 0, stop_s: seconds };
  };
  const colors = assignLabelColors([
    row("walk", 3),
    row("walk", 5, 4),
    row("hop", -1),
    row("", -1),
  ]);
  expect(colors.get("walk")).toBe(getClusterColor(5));
  expect(colors.get("hop")).not.toBe(NO_COLOR);
  expect([getClusterColor(3), getClusterColor(5)]).not.toContain(colors.get("hop"));
  expect(assignLabelColors([row("hop", -1)]).get("hop")).toBe(
    assignLabelColors([row("hop", -1)]).get("hop"),
  );
  expect(colors.size).toBe(2);
});
