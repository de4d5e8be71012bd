import { beforeEach, describe, expect, it, vi } from "vitest";
import type { Edit, Edited, Recording } from "../../src/messages";
import type { Api } from "../../src/studio/server/api";
import { Server } from "./server";
import { row, starts } from "./tables";

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
let lost: number;

function open(): Promise<InstanceType<typeof EditedRecording>> {
  return EditedRecording.open("take", {
    api: server as unknown as Api,
    folder: "/folder",
    lost: () => void (lost += 1),
    tell: (text) => void told.push(text),
  });
}

/** The answer to an edit that named the second primitive, as of a table of that revision. */
function renamedAt(of: number, value: string): Edited {
  const none = { added: [], removed: [] };
  const cells = [{ column: "label", value, rows: [2] }];
  const rows = { removed: [], at: [], added: [], cells, ids: [] };
  const annotation = {
    checked: none,
    by_hand: none,
    comments: null,
    cluster_names: null,
    excluded: null,
  };
  const change = { of, ...rows, ...annotation, corrections: 1 };
  const rest = { can_undo: true, can_redo: false, saved: "take.segments.json", notes: [] };
  return { revision: of + 1, segmentation: null, ids: [], change, ...rest };
}

const settled = () => new Promise((resolve) => setTimeout(resolve, 5));

beforeEach(() => {
  stored.clear();
  server = new Server();
  told = [];
  lost = 0;
});

describe("while the server answers", () => {
  it("an edit is shown at once, and saved once it is confirmed", async () => {
    const edited = await open();
    const done = edited.edit(SPLIT);
    expect(starts(edited.shown.value.segmentation)).toContain(45);
    expect(starts(edited.confirmed.value.segmentation)).not.toContain(45);
    expect(edited.unsent()).toHaveLength(1);
    await done;
    expect(starts(edited.confirmed.value.segmentation)).toContain(45);
    expect(edited.waiting.value).toEqual([]);
    expect(edited.confirmed.value.saved).toBe("take.segments.json");
  });

  it("edits made faster than it answers are sent in order, each on the table before", async () => {
    const edited = await open();
    edited.edit(MOVE);
    edited.edit(SPLIT);
    await settled();
    expect(server.got).toEqual([MOVE, SPLIT]);
    expect(edited.confirmed.value.revision).toBe(2);
  });

  it("the table is made of what the answer tells of it", async () => {
    const edited = await open();
    vi.spyOn(server, "edit").mockResolvedValueOnce(renamedAt(0, "hop"));
    await edited.edit({ kind: "name_segment", level: "primitive", frame: 30, label: "hop" });
    const { revision, segmentation, ids } = edited.confirmed.value;
    expect(revision).toBe(1);
    expect(segmentation.segments.map((each) => each.label)).toEqual(["", "", "hop", ""]);
    expect(segmentation.annotation.corrections).toBe(1);
    expect(ids).toEqual(server.now.ids);
  });

  it("what an answer tells of a table that is not ours is not taken over", async () => {
    const edited = await open();
    vi.spyOn(server, "edit").mockResolvedValueOnce(renamedAt(7, "hop"));
    server.now = { ...server.now, revision: 9 };
    await edited.edit(MOVE);
    expect(edited.confirmed.value).toEqual(server.now);
  });

  it("a command is one of the table that the edits before it leave", async () => {
    const edited = await open();
    const seen: number[][] = [];
    const look = () => void seen.push(starts(edited.shown.value.segmentation));
    void edited.edit(MOVE);
    edited.whenShown(() => {
      look();
      void edited.edit(SPLIT);
    });
    edited.whenShown(look);
    expect(seen).toEqual([
      [0, 40, 60],
      [0, 40, 45, 60],
    ]);
  });

  it("a command waits for an edit of which only the server knows what it makes", async () => {
    server.latency = 5;
    const edited = await open();
    await edited.edit(MOVE);
    edited.edit({ kind: "undo" }); // of what this page has seen: foreseen
    let seen: number[] = [];
    edited.whenShown(() => (seen = starts(edited.shown.value.segmentation)));
    expect(seen).toEqual([0, 30, 60]);
    await edited.settled();
    const again = await open();
    again.edit({ kind: "redo" });
    let settledWhen = -1;
    again.whenShown(() => (settledWhen = again.unsent().length));
    expect(settledWhen).toBe(-1);
    await again.settled();
    expect(settledWhen).toBe(0);
  });

  it("undo where there is nothing to undo is told of, and nothing to decide", async () => {
    const edited = await open();
    edited.edit({ kind: "undo" });
    edited.edit(SPLIT);
    await settled();
    expect(told).toEqual(["It cannot be made."]);
    expect(edited.refused.value).toEqual([]);
    expect(server.got).toEqual([SPLIT]);
  });
});

/** The border at 30 five frames on, one by one; then a name, a kind and a check of its segment. */
function workOn(edited: InstanceType<typeof EditedRecording>): void {
  const segment = () => edited.shown.value.segmentation.segments[2]!;
  for (let i = 0; i < 5; i++) {
    const frame = segment().start_frame;
    void edited.edit({ kind: "move_border", level: "primitive", frame, to: frame + 1 });
  }
  const frame = segment().start_frame;
  void edited.edit({ kind: "name_segment", level: "primitive", frame, label: "hop" });
  void edited.edit({ kind: "check", level: "primitive", frames: [frame], checked: true });
}

function expectWork({ segmentation }: Recording): void {
  expect(starts(segmentation)).toEqual([0, 35, 60]);
  expect(segmentation.segments.map((each) => each.label)).toEqual(["", "", "hop", ""]);
  expect(segmentation.checked).toEqual([2]);
}

describe("however late the server answers", () => {
  it("each edit is one of what it was made on, and none is lost", async () => {
    server.latency = 3;
    const edited = await open();
    workOn(edited);
    expectWork(edited.shown.value);
    await edited.settled();
    expectWork(server.now);
    expectWork(edited.confirmed.value);
    expect(server.got).toHaveLength(7);
    expect(edited.refused.value).toEqual([]);
  });

  it("an outage is nothing but a long latency", async () => {
    const edited = await open();
    server.up = false;
    workOn(edited);
    await settled();
    expectWork(edited.shown.value);
    expect(edited.unsent()).toHaveLength(7);
    server.up = true;
    await edited.resume();
    expectWork(server.now);
    expect(server.got).toHaveLength(7);
  });

  it("what was shown does not change when the answer comes", async () => {
    server.latency = 2;
    const edited = await open();
    workOn(edited);
    const seen = new Set([edited.shown.value.segmentation]);
    edited.shown.subscribe((each) => void seen.add(each.segmentation));
    await edited.settled();
    expect(seen.size).toBe(1);
    expect([...seen][0]).toEqual(server.now.segmentation);
  });

  it("undo takes back what has not been sent yet", async () => {
    const edited = await open();
    server.up = false;
    edited.edit(MOVE);
    edited.edit(SPLIT);
    edited.undo();
    expect(starts(edited.shown.value.segmentation)).toEqual([0, 40, 60]);
    await settled();
    server.up = true;
    await edited.resume();
    expect(starts(server.now.segmentation)).toEqual([0, 40, 60]);
  });
});

describe("what the server refuses", () => {
  const GONE: Edit = { kind: "delete_border", level: "primitive", frame: 30 };
  beforeEach(() => {
    server.refuses = ({ kind }) => kind === "delete_border";
  });

  it("stays until somebody decides, and holds up nothing else", async () => {
    const edited = await open();
    edited.edit(GONE);
    edited.edit(SPLIT);
    await settled();
    expect(server.got).toEqual([SPLIT]);
    expect(edited.refused.value).toMatchObject([{ edit: GONE, refused: "It cannot be made." }]);
    edited.dropRefused();
    expect(edited.refused.value).toEqual([]);
    expect(stored.size).toBe(0);
  });

  it("outlives the tab, and can be tried again", async () => {
    const first = await open();
    first.edit(GONE);
    await settled();
    first.close();
    const edited = await open();
    expect(edited.refused.value).toHaveLength(1);
    await edited.edit(MOVE);
    server.refuses = () => false;
    edited.retryRefused();
    await settled();
    expect(edited.refused.value).toEqual([]);
    expect(server.got.at(-1)).toEqual({ ...GONE, frame: 40 }); // where that border is now
    expect(starts(server.now.segmentation)).toEqual([0, 60]);
  });

  it("and was taken back by its author is no edit at all: undo does not reach the one before", async () => {
    const edited = await open();
    await edited.edit(MOVE);
    server.latency = 2;
    edited.edit(GONE);
    edited.undo();
    await edited.settled();
    expect(server.got).toEqual([MOVE]);
    expect(edited.refused.value).toEqual([]);
  });

  it("and was never shown as made is told of at once, and nothing to decide", async () => {
    const edited = await open();
    edited.edit({ kind: "delete_border", level: "primitive", frame: 31 });
    await settled();
    expect(told).toEqual(["It cannot be made."]);
    expect(edited.refused.value).toEqual([]);
  });
});

it("as many edits are undone as undo was asked for, however fast", async () => {
  const edited = await open();
  for (let i = 0; i < 4; i++) edited.undo();
  expect(edited.waiting.value.map(({ edit }) => edit.kind)).toEqual(Array(4).fill("undo"));
});

describe("when the server is gone", () => {
  it("edits wait, are told of, and are sent when it is back", async () => {
    const edited = await open();
    server.up = false;
    edited.edit(MOVE);
    edited.edit(SPLIT);
    await settled();
    expect(lost).toBeGreaterThan(0);
    expect(edited.unsent()).toHaveLength(2);
    server.up = true;
    await edited.resume();
    expect(server.got).toEqual([MOVE, SPLIT]);
    expect(edited.unsent()).toEqual([]);
  });

  it("an edit that was saved before the answer was lost is not made twice", async () => {
    const edited = await open();
    server.dieAfterSaving = true;
    edited.edit(MOVE);
    await settled();
    expect(edited.unsent()).toHaveLength(1);
    server.dieAfterSaving = false;
    server.up = true;
    await edited.resume();
    expect(edited.unsent()).toEqual([]);
    expect(edited.blocked.value).toBeNull();
    expect(server.got).toEqual([MOVE]);
  });

  it("an edit that took its own segment away is known to the next tab's server, too", async () => {
    const edited = await open();
    server.dieAfterSaving = true;
    edited.edit({ kind: "delete_border", level: "primitive", frame: 30 });
    edited.edit({ kind: "name_segment", level: "primitive", frame: 0, label: "whole" });
    await settled();
    edited.close();
    server.dieAfterSaving = false;
    server.up = true;
    const next = await open();
    await settled();
    expect(next.refused.value).toEqual([]);
    expect(server.got).toHaveLength(2);
    expect(next.shown.value.segmentation.segments[1]!.label).toBe("whole");
  });

  it("the next tab may find a server that is still looking for segments", async () => {
    const edited = await open();
    server.up = false;
    edited.edit({ kind: "name_segment", level: "primitive", frame: 30, label: "hop" });
    await settled();
    edited.close();
    server.up = true;
    const bare = [row("activity", 0, 100), row("primitive", 0, 100)];
    const segmentation = { ...server.now.segmentation, segments: bare };
    const ids = ["a:0", "p:0"];
    const finding = { ...server.now, segmentation, ids, finding: true, revision: -1 };
    vi.spyOn(server, "recording").mockResolvedValueOnce(finding);
    const next = await open();
    await settled();
    expect(next.refused.value).toEqual([]);
    expect(server.got).toMatchObject([{ frame: 30, label: "hop" }]);
    expect(next.shown.value.finding).toBe(false); // else it could never be edited again
  });

  it("a tab that dies, too, leaves its edits to the next one", async () => {
    const edited = await open();
    server.up = false;
    edited.edit(MOVE);
    await settled();
    edited.close();
    server.up = true;
    const next = await open();
    await settled();
    expect(starts(next.confirmed.value.segmentation)).toContain(40);
    expect(stored.size).toBe(0);
  });
});

describe("when somebody else changes the table", () => {
  it("an edit of the old table is kept and made only when asked for", async () => {
    const edited = await open();
    await server.edit("take", { revision: 0, edit: MOVE });
    edited.edit(SPLIT);
    await settled();
    expect(edited.blocked.value).toBe("The table has changed.");
    expect(edited.unsent()).toHaveLength(1);
    expect(starts(edited.confirmed.value.segmentation)).toEqual([0, 40, 60]);
    edited.retry();
    await settled();
    expect(starts(server.now.segmentation)).toEqual([0, 40, 45, 60]);
    expect(edited.blocked.value).toBeNull();
  });

  it("it is made on what it was made on, wherever somebody has put that", async () => {
    const edited = await open();
    await server.edit("take", { revision: 0, edit: MOVE });
    edited.edit({ kind: "name_segment", level: "primitive", frame: 30, label: "hop" });
    await settled();
    edited.retry();
    await settled();
    const named = { kind: "name_segment", level: "primitive", frame: 40, label: "hop" };
    expect(server.got.at(-1)).toEqual(named);
  });

  it("what it was made on may be gone: then it is refused, and made on nothing else", async () => {
    const edited = await open();
    const gone: Edit = { kind: "delete_border", level: "primitive", frame: 30 };
    await server.edit("take", { revision: 0, edit: gone });
    await server.edit("take", { revision: 1, edit: { ...SPLIT, frame: 30 } });
    edited.edit({ kind: "name_segment", level: "primitive", frame: 30, label: "hop" });
    await settled();
    edited.retry();
    await settled();
    expect(server.got).toHaveLength(2);
    expect(edited.refused.value).toHaveLength(1);
  });

  it("edits made since are on the table as it is, and stay when the others are dropped", async () => {
    const edited = await open();
    await server.edit("take", { revision: 0, edit: MOVE });
    edited.edit({ kind: "delete_border", level: "primitive", frame: 60 });
    await settled();
    edited.edit(SPLIT);
    expect(starts(edited.shown.value.segmentation)).toEqual([0, 40, 45, 60]);
    edited.drop();
    await settled();
    expect(starts(server.now.segmentation)).toEqual([0, 40, 45, 60]);
  });

  it("it can be dropped, too", async () => {
    const edited = await open();
    await server.edit("take", { revision: 0, edit: MOVE });
    edited.edit(SPLIT);
    await settled();
    edited.drop();
    await settled();
    expect(starts(edited.confirmed.value.segmentation)).toEqual([0, 40, 60]);
    expect(server.got).toEqual([MOVE]);
  });

  it("the table is loaded anew when the server tells", async () => {
    const edited = await open();
    await server.edit("take", { revision: 0, edit: MOVE });
    await edited.changed(1);
    expect(starts(edited.confirmed.value.segmentation)).toEqual([0, 40, 60]);
    expect(told).toHaveLength(1);
  });

  it("a table asked for before an edit, and told after it, does not hide the edit", async () => {
    const edited = await open();
    const old = server.now;
    let answer: (recording: Recording) => void = () => undefined;
    vi.spyOn(server, "recording").mockReturnValueOnce(new Promise((done) => (answer = done)));
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
    await settled();
    expect(edited.blocked.value).toBeNull();
    expect(server.got).toEqual([SPLIT]);
  });
});
