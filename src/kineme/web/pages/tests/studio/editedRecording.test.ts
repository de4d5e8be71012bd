import { beforeEach, describe, expect, it, vi } from "vitest";
import type { Edit, Edited, Recording } from "../../src/messages";
import type { Api } from "../../src/studio/server/api";
import { Server } from "./server";
import { recording, row, starts } from "./tables";

const stored = new Map<string, string>();
const storage = new Proxy(
  {
    getItem: (key: string) => stored.get(key) ?? null,
    setItem: (key: string, value: string) => void stored.set(key, value),
    removeItem: (key: string) => void stored.delete(key),
  },
  {
    ownKeys: () => [...stored.keys()],
    getOwnPropertyDescriptor: () => ({ enumerable: true, configurable: true }),
  },
);
vi.stubGlobal("sessionStorage", { getItem: () => "this-tab", setItem: () => undefined });
vi.stubGlobal("localStorage", storage);
vi.stubGlobal("navigator", { locks: { query: () => Promise.resolve({ held: [] }) } });

const { EditedRecording } = await import("../../src/studio/editing/editedRecording");

const SPLIT: Edit = { kind: "split", level: "primitive", frame: 45 };
const MOVE: Edit = { kind: "move_border", level: "primitive", frame: 30, to: 40 };

let server: Server;
let told: string[];
let warned: string[];
let away: boolean;

function open(): Promise<InstanceType<typeof EditedRecording>> {
  return EditedRecording.open("take", {
    api: server as unknown as Api,
    folder: "/folder",
    isOffline: () => away,
    onConnectionLost: () => void (away = true),
    tell: (text) => void told.push(text),
    warn: (text) => void warned.push(text),
  });
}

/** Return the answer to an edit of revision `of` that named the second primitive. */
function createAnswer(of: number, label: string): Edited {
  const rows = [{ ...recording().segmentation.segments[2]!, label }];
  const change = { of, removed: [], rows, cluster_names: {} };
  const rest = { can_undo: true, can_redo: false, saved: "take.segments.json", notes: [] };
  return { revision: of + 1, change, segmentation: null, ...rest };
}

const waitForAnswer = () => new Promise((resolve) => setTimeout(resolve, 5));

beforeEach(() => {
  stored.clear();
  server = new Server();
  [told, warned] = [[], []];
  away = false;
});

function waitUntilBack(edited: InstanceType<typeof EditedRecording>): Promise<void> {
  server.up = true;
  away = false;
  return edited.resume();
}

describe("while the server answers", () => {
  it("an edit is shown and saved once it is answered", async () => {
    const edited = await open();
    let seen: number[] = [];
    const done = edited.edit(SPLIT, () => (seen = starts(edited.confirmed.value.segmentation)));
    expect(starts(edited.confirmed.value.segmentation)).not.toContain(45);
    expect(edited.describeUnsent()).toHaveLength(1);
    await done;
    expect(seen).toContain(45);
    expect(edited.describeUnsent()).toEqual([]);
    expect(edited.confirmed.value.saved).toBe("take.segments.json");
  });

  it("edits made faster than it answers are sent in order, each on the table before", async () => {
    const edited = await open();
    edited.edit(MOVE);
    edited.edit(SPLIT);
    await waitForAnswer();
    expect(server.got).toEqual([MOVE, SPLIT]);
    expect(edited.confirmed.value.revision).toBe(2);
  });

  it("the table is made of what the answer tells of it", async () => {
    const edited = await open();
    vi.spyOn(server, "sendEdit").mockResolvedValueOnce(createAnswer(0, "hop"));
    await edited.edit({ kind: "name_segment", level: "primitive", frame: 30, label: "hop" });
    const { revision, segmentation } = edited.confirmed.value;
    expect(revision).toBe(1);
    expect(segmentation.segments.map((each) => each.label)).toEqual(["", "", "hop", ""]);
  });

  it("an edit that was begun before the last answer follows the segment it names", async () => {
    const edited = await open();
    const { segmentation } = edited.confirmed.value;
    await edited.edit(MOVE);
    const NAME: Edit = { kind: "name_segment", level: "primitive", frame: 30, label: "hop" };
    await edited.edit(NAME, undefined, segmentation);
    expect(server.got).toEqual([MOVE, { ...NAME, frame: 40 }]);
  });

  it("what an answer tells of a table that is not ours is not taken over", async () => {
    const edited = await open();
    vi.spyOn(server, "sendEdit").mockResolvedValueOnce(createAnswer(7, "hop"));
    server.now = { ...server.now, revision: 9 };
    await edited.edit(MOVE);
    expect(edited.confirmed.value).toEqual(server.now);
  });

  it("commands see the table of the edits before them, and come in the order they were given", async () => {
    server.latency = 2;
    const edited = await open();
    const seen: number[][] = [];
    const look = () => void seen.push(starts(edited.confirmed.value.segmentation));
    edited.edit(MOVE);
    edited.runWhenShown(() => {
      look();
      edited.edit(SPLIT);
    });
    edited.edit({ ...SPLIT, frame: 80 });
    edited.runWhenShown(look);
    expect(edited.describeUnsent()).toHaveLength(4);
    await edited.waitUntilSent();
    expect(seen).toEqual([
      [0, 40, 60],
      [0, 40, 45, 60, 80],
    ]);
    expect(server.got).toEqual([MOVE, SPLIT, { ...SPLIT, frame: 80 }]);
  });
});

it("each edit is one of the segments that it was made on, however late the answers", async () => {
  server.latency = 3;
  const edited = await open();
  for (const to of [31, 32, 33]) edited.edit({ ...MOVE, to });
  edited.edit({ kind: "name_segment", level: "primitive", frame: 30, label: "hop" });
  edited.edit({ kind: "check", level: "primitive", frames: [30], checked: true });
  edited.edit({ kind: "merge", level: "primitive", start_frame: 0, stop_frame: 30 });
  await edited.waitUntilSent();
  const { segmentation } = edited.confirmed.value;
  expect(starts(segmentation)).toEqual([0, 33, 60]);
  expect(segmentation.segments.map((each) => each.label)).toEqual(["", "", "hop", ""]);
  expect(segmentation.segments.map((each) => each.checked ?? false)).toEqual([
    ...[false, false, true, false],
  ]);
  expect(server.got).toHaveLength(5); // it does not know how to merge
  expect(warned).toEqual([
    "Not made: primitives merged from 0.00 s to 3.30 s (It cannot be made.).",
  ]);
});

describe("what the server refuses", () => {
  const GONE: Edit = { kind: "delete_border", level: "primitive", frame: 30 };
  beforeEach(() => {
    server.refuses = ({ kind }) => kind === "delete_border";
  });

  it("is named, and holds up nothing else", async () => {
    const edited = await open();
    edited.edit(GONE);
    edited.edit(SPLIT);
    await waitForAnswer();
    expect(server.got).toEqual([SPLIT]);
    expect(warned).toEqual(["Not made: primitive border at 3.00 s deleted (It cannot be made.)."]);
    expect(stored.size).toBe(0);
  });

  it("and was taken back by its author is no edit at all: undo does not reach the one before", async () => {
    const edited = await open();
    await edited.edit(MOVE);
    server.latency = 2;
    edited.edit(GONE);
    edited.undo();
    await edited.waitUntilSent();
    expect(server.got).toEqual([MOVE]);
    expect([told, warned]).toEqual([["It cannot be made."], []]);
  });

  it("undo where there is nothing to undo is told of in passing", async () => {
    const edited = await open();
    edited.edit({ kind: "undo" });
    edited.edit(SPLIT);
    await waitForAnswer();
    expect([told, warned]).toEqual([["It cannot be made."], []]);
    expect(server.got).toEqual([SPLIT]);
  });

  it("is shown as it was, also where a box was ticked for it", async () => {
    const edited = await open();
    const before = edited.confirmed.value.segmentation;
    await edited.edit(GONE);
    expect(edited.confirmed.value.segmentation).toEqual(before);
    expect(edited.confirmed.value.segmentation).not.toBe(before);
  });
});

it("as many edits are undone as undo was asked for, however fast", async () => {
  server.latency = 2;
  const edited = await open();
  edited.edit(MOVE);
  edited.edit(SPLIT);
  edited.undo();
  edited.undo();
  await edited.waitUntilSent();
  expect(starts(edited.confirmed.value.segmentation)).toEqual([0, 30, 60]);
  expect(edited.confirmed.value.revision).toBe(4);
});

describe("when the server is gone", () => {
  it("edits wait, are told of, and are sent when it is back", async () => {
    const edited = await open();
    server.up = false;
    edited.edit(MOVE);
    edited.edit(SPLIT);
    await waitForAnswer();
    expect(away).toBe(true);
    expect(edited.describeUnsent()).toHaveLength(2);
    await waitUntilBack(edited);
    expect(server.got).toEqual([MOVE, SPLIT]);
    expect(edited.describeUnsent()).toEqual([]);
  });

  it("a key that was pressed before is obeyed, also if an earlier outage is told of late", async () => {
    server.latency = 2;
    const edited = await open();
    edited.edit(MOVE);
    edited.runWhenShown(() => void edited.edit(SPLIT));
    await Promise.resolve();
    away = true; // the late answer to another request says so
    await edited.waitUntilSent();
    expect(server.got).toEqual([MOVE, SPLIT]);
    expect(told).toEqual([]);
  });

  it("nothing more is taken, and that is said", async () => {
    const edited = await open();
    away = true;
    await edited.edit(MOVE);
    edited.runWhenShown(() => void edited.edit(SPLIT));
    expect(edited.describeUnsent()).toEqual([]);
    expect(told).toEqual(Array(2).fill("Not done: the studio’s server does not answer."));
    await waitUntilBack(edited);
    expect(server.got).toEqual([]);
  });

  it("an edit that was saved before the answer was lost is not made twice", async () => {
    const edited = await open();
    server.dieAfterSaving = true;
    edited.edit(MOVE);
    await waitForAnswer();
    expect(edited.describeUnsent()).toHaveLength(1);
    server.dieAfterSaving = false;
    await waitUntilBack(edited);
    expect(edited.describeUnsent()).toEqual([]);
    expect(edited.blocked.value).toBeNull();
    expect(server.got).toEqual([MOVE]);
  });

  it("an edit that took its own segment away is known to the next tab's server, too", async () => {
    const edited = await open();
    server.dieAfterSaving = true;
    edited.edit({ kind: "delete_border", level: "primitive", frame: 30 });
    edited.edit({ kind: "name_segment", level: "primitive", frame: 0, label: "whole" });
    await waitForAnswer();
    edited.close();
    server.dieAfterSaving = false;
    [server.up, away] = [true, false];
    const next = await open();
    await waitForAnswer();
    expect(warned).toEqual([]);
    expect(server.got).toHaveLength(2);
    expect(next.confirmed.value.segmentation.segments[1]!.label).toBe("whole");
  });

  it("the next tab may find a server that is still looking for segments", async () => {
    const edited = await open();
    server.up = false;
    edited.edit({ kind: "name_segment", level: "primitive", frame: 30, label: "hop" });
    await waitForAnswer();
    edited.close();
    [server.up, away] = [true, false];
    const bare = [row("activity", 0, 100), row("primitive", 0, 100)];
    const segmentation = { ...server.now.segmentation, segments: bare };
    const finding = { ...server.now, segmentation, finding: true, revision: -1 };
    vi.spyOn(server, "loadRecording").mockResolvedValueOnce(finding);
    const next = await open();
    await waitForAnswer();
    expect(warned).toEqual([]);
    expect(server.got).toMatchObject([{ frame: 30, label: "hop" }]);
    expect(next.confirmed.value.finding).toBe(false); // else it could never be edited again
  });

  it("a tab that dies, too, leaves its edits to the next one", async () => {
    const edited = await open();
    server.up = false;
    edited.edit(MOVE);
    await waitForAnswer();
    edited.close();
    [server.up, away] = [true, false];
    const next = await open();
    await waitForAnswer();
    expect(starts(next.confirmed.value.segmentation)).toContain(40);
    expect(stored.size).toBe(0);
  });
});

describe("when somebody else changes the table", () => {
  it("an edit of the old table is kept and made only when asked for", async () => {
    const edited = await open();
    await server.sendEdit("take", { revision: 0, edit: MOVE });
    edited.edit(SPLIT);
    await waitForAnswer();
    expect(edited.blocked.value).toBe("The table has changed.");
    expect(edited.describeUnsent()).toHaveLength(1);
    expect(starts(edited.confirmed.value.segmentation)).toEqual([0, 40, 60]);
    edited.retry();
    await waitForAnswer();
    expect(starts(server.now.segmentation)).toEqual([0, 40, 45, 60]);
    expect(edited.blocked.value).toBeNull();
  });

  it("it is made on what it was made on, wherever somebody has put that", async () => {
    const edited = await open();
    await server.sendEdit("take", { revision: 0, edit: MOVE });
    edited.edit({ kind: "name_segment", level: "primitive", frame: 30, label: "hop" });
    await waitForAnswer();
    edited.retry();
    await waitForAnswer();
    const named = { kind: "name_segment", level: "primitive", frame: 40, label: "hop" };
    expect(server.got.at(-1)).toEqual(named);
  });

  it("what it was made on may be gone: then it is refused, and made on nothing else", async () => {
    const edited = await open();
    const gone: Edit = { kind: "delete_border", level: "primitive", frame: 30 };
    await server.sendEdit("take", { revision: 0, edit: gone });
    edited.edit({ kind: "name_segment", level: "primitive", frame: 30, label: "hop" });
    await waitForAnswer();
    edited.retry();
    await waitForAnswer();
    expect(server.got).toHaveLength(1);
    expect(warned[0]).toContain("not there any more");
  });

  it("nothing more is edited until somebody decides", async () => {
    const edited = await open();
    await server.sendEdit("take", { revision: 0, edit: MOVE });
    edited.edit({ kind: "delete_border", level: "primitive", frame: 60 });
    await waitForAnswer();
    await edited.edit(SPLIT);
    expect(told).toEqual(["Not done: first choose what becomes of the edits above."]);
    expect(edited.describeUnsent()).toHaveLength(1);
  });

  it("it can be dropped, too", async () => {
    const edited = await open();
    await server.sendEdit("take", { revision: 0, edit: MOVE });
    edited.edit(SPLIT);
    await waitForAnswer();
    edited.discardEdits();
    await waitForAnswer();
    expect(starts(edited.confirmed.value.segmentation)).toEqual([0, 40, 60]);
    expect(server.got).toEqual([MOVE]);
  });

  it("the table is loaded anew when the server tells", async () => {
    const edited = await open();
    await server.sendEdit("take", { revision: 0, edit: MOVE });
    await edited.handleChange(1);
    expect(starts(edited.confirmed.value.segmentation)).toEqual([0, 40, 60]);
    expect(told).toHaveLength(1);
  });

  it("a table asked for before an edit, and told after it, does not hide the edit", async () => {
    const edited = await open();
    const old = server.now;
    let answer: (recording: Recording) => void = () => undefined;
    vi.spyOn(server, "loadRecording").mockReturnValueOnce(new Promise((done) => (answer = done)));
    const asked = edited.resume();
    await edited.edit(SPLIT);
    answer(old);
    await asked;
    expect(edited.confirmed.value.revision).toBe(server.now.revision);
    expect(starts(edited.confirmed.value.segmentation)).toContain(45);
  });

  it("a server that counts anew but has the same table just gets the edit", async () => {
    const edited = await open();
    server.now = { ...server.now, revision: 7 };
    edited.edit(SPLIT);
    await waitForAnswer();
    expect(edited.blocked.value).toBeNull();
    expect(server.got).toEqual([SPLIT]);
  });
});
