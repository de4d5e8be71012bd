import { beforeEach, expect, test } from "vitest";
import { FPS, starts, table } from "../studio/tables";
import { show, type Page } from "./page";

let page: Page;

beforeEach(async () => {
  page = await show(<></>, table());
  page.server.latency = 3;
});
const goTo = (frame: number): void => page.store.seek(frame / FPS);
const waitUntilSent = (): Promise<void> => page.services.session.edited.value!.waitUntilSent();
const listStarts = (): number[] => starts(page.store.table.value!);

test("keys are for where the playhead was, in the table that the edits before them leave", async () => {
  const { editor } = page.services;
  goTo(20);
  editor.split();
  goTo(22);
  editor.deleteBorder(); // the one that was just made
  goTo(80);
  editor.split();
  goTo(0);
  expect(listStarts()).toEqual([0, 30, 60]);
  await waitUntilSent();
  expect(page.server.got).toEqual([
    { kind: "split", level: "primitive", frame: 20 },
    { kind: "delete_border", level: "primitive", frame: 20 },
    { kind: "split", level: "primitive", frame: 80 },
  ]);
});

test("a border is moved by each key, also by those released before their turn", async () => {
  const { editor } = page.services;
  goTo(30);
  for (let i = 0; i < 3; i++) {
    editor.nudge(1);
    editor.release();
  }
  await waitUntilSent();
  expect(listStarts()).toEqual([0, 33, 60]);
  expect(page.store.drag.value).toBeNull();
});

test("a key after one that moves a border is for the segment of that border", async () => {
  const { editor, review } = page.services;
  goTo(20);
  editor.split();
  editor.nudge(1); // before the border is there
  editor.release();
  review.toggleChecked();
  await waitUntilSent();
  expect(listStarts()).toEqual([0, 21, 30, 60]);
  expect(page.store.table.value!.segments.map((row) => row.checked ?? false)).toEqual([
    ...[false, false, true, false, false],
  ]);
  expect(page.store.frame.value).toBe(21);
});

test("a border that is moved late does not take the playhead from where it is by then", async () => {
  const { editor } = page.services;
  goTo(20);
  editor.split();
  editor.nudge(1);
  editor.release();
  goTo(80);
  await waitUntilSent();
  expect(listStarts()).toEqual([0, 21, 30, 60]);
  expect(page.store.frame.value).toBe(80);
});

test("an edit is made on the recording that was in front when the key was pressed", async () => {
  const { editor, session } = page.services;
  const edited = session.edited.value!;
  goTo(20);
  editor.split();
  goTo(80);
  editor.split();
  session.close("take");
  await edited.waitUntilSent();
  expect(starts(page.server.now.segmentation)).toEqual([0, 20, 30, 60, 80]);
});
