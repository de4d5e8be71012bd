import { beforeEach, expect, test } from "vitest";
import type { Store } from "../src/store";
import { TimelineGestures } from "../src/panels/Timeline";
import { GUTTER_WIDTH, layOutLanes, type Lane } from "../src/panels/lanes";
import { createTable, openStore, recording, segment } from "./recordings";

const PIXELS = 4; // to a frame
const ROWS = [
  segment(0, 100, { level: "activity" }),
  segment(0, 40),
  segment(40, 41), // four pixels
  segment(41, 100),
];

let store: Store;
let moves: [level: string, frame: number, to: number][];
let lanes: Lane[];
let gestures: TimelineGestures;

beforeEach(() => {
  store = openStore(recording(createTable(ROWS)));
  moves = [];
  store.edit.value = (edit) => {
    if (edit.kind === "move_border") moves.push([edit.level, edit.frame, edit.to]);
  };
  const { activities, primitives } = store;
  lanes = layOutLanes(
    { activities: activities.value, primitives: primitives.value, labels: [], others: [] },
    160,
  );
  gestures = new TimelineGestures(store, () => lanes);
});

/** Create a press on the primitives' lane, some pixels beside a frame. */
function at(frame: number, pixels = 0, pointerType = "mouse"): PointerEvent {
  const lane = lanes.find(({ id }) => id === "primitive")!;
  const width = GUTTER_WIDTH + 100 * PIXELS;
  return {
    button: 0,
    pointerId: 1,
    pointerType,
    clientX: GUTTER_WIDTH + frame * PIXELS + pixels,
    clientY: lane.top + lane.height / 2,
    currentTarget: {
      getBoundingClientRect: () => ({ left: 0, top: 0, width }),
      setPointerCapture: () => undefined,
      style: {},
    },
  } as unknown as PointerEvent;
}

function press(...events: PointerEvent[]): void {
  gestures.down(events[0]!);
  for (const event of events.slice(1)) gestures.move(event);
  gestures.up(events.at(-1)!);
}

test("a press that hardly moves selects, also beside a border, and moves nothing", () => {
  for (const jitter of [0, 1, -1, 4, -4]) {
    press(at(41, 1), at(41, 1 + jitter));
    expect(moves).toEqual([]);
    expect(store.drag.value).toBeNull();
    expect(store.selected.value?.start_frame).toBe(41);
    store.selection.value = null;
  }
});

test("a segment narrower than the grips of its borders can be chosen", () => {
  for (const pointer of ["mouse", "touch"]) {
    press(at(40, 2, pointer));
    expect(store.selected.value?.start_frame).toBe(40);
    store.selection.value = null;
  }
});

test("a border goes as far as the pointer, wherever it was taken", () => {
  press(at(41, 3), at(41, 13), at(41, 43));
  expect(moves).toEqual([["primitive", 41, 51]]);
  expect(store.drag.value).toMatchObject({ frame: 41, to: 51 }); // until the table shows it
  press(at(40, -4), at(40, -14), at(40, -44));
  expect(moves.at(-1)).toEqual(["primitive", 40, 30]);
});

test("a dragged border follows from where it stood, once the press has become a drag", () => {
  gestures.down(at(41, 3));
  gestures.move(at(41, 7));
  expect(store.drag.value).toBeNull();
  gestures.move(at(41, 8));
  expect(store.drag.value).toMatchObject({ frame: 41, to: 42 });
  expect(gestures.cancelDrag()).toBe(true);
  expect(moves).toEqual([]);
});

test("in the middle of a segment a drag moves the view, not a border", () => {
  store.zoom.value = { start_s: 2, stop_s: 8 };
  press(at(60), at(60, 10), at(60, 40));
  expect(moves).toEqual([]);
  expect(store.range.value.start_s).toBeLessThan(2);
});
