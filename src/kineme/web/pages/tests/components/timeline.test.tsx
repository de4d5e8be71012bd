import { fireEvent, waitFor } from "@testing-library/preact";
import { beforeEach, expect, test } from "vitest";
import { Timeline } from "../../src/panels/Timeline";
import { GUTTER_WIDTH, layOutLanes } from "../../src/panels/lanes";
import { row, table } from "../studio/tables";
import { HEIGHT, WIDTH, readTexts } from "../browser";
import { show, type Page } from "./page";

const FRAMES = 100;
const rows = [
  row("activity", 0, 100, 0, "gymnastics"),
  row("primitive", 0, 30, 0, "hop"),
  row("primitive", 30, 60, 1, "squat"),
  row("primitive", 60, 100, 0, "hop"),
];

let page: Page;
let canvas: HTMLElement;

beforeEach(async () => {
  page = await show(<Timeline />, { ...table(), segments: rows });
  canvas = page.getByRole("img", { name: /Segments over time/ });
  readTexts(canvas); // lanes exist only after drawing
});

/** Return the pointer position of a frame on the primitives' lane. */
function at(frame: number): PointerEventInit {
  const { activities, primitives } = page.store;
  const shown = { activities: activities.value, primitives: primitives.value };
  const lane = layOutLanes({ ...shown, labels: [], others: [] }, HEIGHT).find(
    ({ id }) => id === "primitive",
  )!;
  const clientX = GUTTER_WIDTH + ((WIDTH - GUTTER_WIDTH) * frame) / FRAMES;
  return { clientX, clientY: lane.top + lane.height / 2, button: 0, pointerId: 1 };
}

function drag(from: number, to: number): void {
  fireEvent.pointerDown(canvas, at(from));
  fireEvent.pointerMove(canvas, at(to));
}

test("shows the lanes, and the names of segments in them", () => {
  const texts = readTexts(canvas);
  expect(texts).toEqual(expect.arrayContaining(["Activities", "Primitives", "Labels"]));
  expect(texts.filter((text) => text === "hop").length).toBeGreaterThanOrEqual(2);
  expect(texts).toContain("gymnastics");
});

test("a click chooses a segment, and says which to those who do not see it", async () => {
  fireEvent.pointerDown(canvas, at(45));
  fireEvent.pointerUp(canvas, at(45));
  expect(page.store.selected.value?.start_frame).toBe(30);
  await waitFor(() =>
    expect(page.getByRole("status").textContent).toBe(
      "primitive squat, from 0:03.00, 3.00 seconds",
    ),
  );
});

test("a border that is dragged is moved on the server, and drawn where it is", async () => {
  drag(30, 40);
  fireEvent.pointerUp(canvas, at(40));
  expect(page.store.drag.value).toMatchObject({ frame: 30, to: 40 }); // until the table shows it
  await waitFor(() => expect(page.store.drag.value).toBeNull());
  expect(page.store.primitives.value.map((each) => each.start_frame)).toEqual([0, 40, 60]);
  expect(page.server.got).toEqual([{ kind: "move_border", level: "primitive", frame: 30, to: 40 }]);
});

test("Escape gives a dragged border up", () => {
  drag(30, 40);
  expect(page.store.frame.value).toBe(40); // the playhead goes with it
  fireEvent.keyDown(window, { key: "Escape" });
  fireEvent.pointerUp(canvas, at(40));
  expect(page.store.primitives.value.map((each) => each.start_frame)).toEqual([0, 30, 60]);
  expect(page.server.got).toEqual([]);
});

test("a name that is given is drawn", async () => {
  page.services.editor.nameSegment(page.store.primitives.value[1]!, "lunge");
  await waitFor(() => expect(readTexts(canvas)).toContain("lunge"));
  expect(readTexts(canvas)).not.toContain("squat");
});
