import { beforeEach, describe, expect, it, vi } from "vitest";
import type { Edit, Edited, EditRequest, Recording } from "../../src/messages";
import type { Api } from "../../src/studio/server/api";
import { laneOf } from "../../src/segments";
import { recording, row, starts, table } from "./tables";

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

const { Refused, Unreachable } = await import("../../src/studio/server/api");
const { EditedRecording } = await import("../../src/studio/editing/editedRecording");

const SPLIT: Edit = { kind: "split", level: "primitive", frame: 45 };
const MOVE: Edit = { kind: "move_border", level: "primitive", frame: 30, to: 40 };

/** A server that holds one table, knows edits by name, can be switched off, or die once it saved. */
class Server {
  now: Recording = recording();
  up = true;
  dieAfterSaving = false;
  readonly got: Edit[] = [];
  private readonly known = new Set<string>();

  recording(): Promise<Recording> {
    return this.up ? Promise.resolve(this.now) : Promise.reject(new Unreachable());
  }

  async edit(_id: string, { revision, edit, name }: EditRequest): Promise<Edited> {
    if (!this.up) throw new Unreachable();
    if (name && this.known.has(name)) return { ...this.now, notes: [] };
    if (revision !== this.now.revision) throw new Refused(409, "The table has changed.", {});
    if (edit.kind === "undo") throw new Refused(400, "There is nothing to undo.", {});
    this.got.push(edit);
    if (name) this.known.add(name);
    const cuts = edit.kind === "split" || edit.kind === "move_border";
    const segmentation = cuts ? cutAnew(this.now, edit) : table();
    this.now = { ...this.now, segmentation, revision: revision + 1, saved: "take.segments.json" };
    if (this.dieAfterSaving) {
      this.up = false;
      throw new Unreachable();
    }
    return { ...this.now, notes: [] };
  }
}

/** The table with the border of SPLIT, or MOVE. */
function cutAnew({ segmentation }: Recording, edit: Edit): Recording["segmentation"] {
  const cuts = laneOf(segmentation, "primitive").map((each) => each.start_frame);
  const now = edit.kind === "split" ? [...cuts, 45] : cuts.map((cut) => (cut === 30 ? 40 : cut));
  const sorted = [...now.sort((a, b) => a - b), 100];
  const rows = sorted.slice(1).map((stop, i) => row("primitive", sorted[i]!, stop));
  return { ...segmentation, segments: [row("activity", 0, 100), ...rows] };
}

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

const settled = () => new Promise((resolve) => setTimeout(resolve, 5));

beforeEach(() => {
  stored.clear();
  server = new Server();
  told = [];
  lost = 0;
});

describe("while the server answers", () => {
  it("an edit is shown once it is confirmed", async () => {
    const edited = await open();
    const done = edited.edit(SPLIT);
    expect(starts(edited.confirmed.value.segmentation)).not.toContain(45);
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

  it("a command is one of the table that the edits before it leave", async () => {
    const edited = await open();
    const seen: number[][] = [];
    const look = () => void seen.push(starts(edited.confirmed.value.segmentation));
    void edited.edit(MOVE);
    edited.whenSettled(() => {
      look();
      void edited.edit(SPLIT);
    });
    edited.whenSettled(look);
    await settled();
    expect(seen).toEqual([
      [0, 40, 60],
      [0, 40, 45, 60],
    ]);
  });

  it("an edit that is refused for what it is goes, with the reason", async () => {
    const edited = await open();
    edited.edit({ kind: "undo" });
    edited.edit(SPLIT);
    await settled();
    expect(told).toEqual(["There is nothing to undo."]);
    expect(server.got).toEqual([SPLIT]);
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
    expect(edited.held.value).toBeNull();
    expect(server.got).toEqual([MOVE]);
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
    expect(edited.held.value).toBe("The table has changed.");
    expect(edited.unsent()).toHaveLength(1);
    expect(starts(edited.confirmed.value.segmentation)).toEqual([0, 40, 60]);
    edited.retry();
    await settled();
    expect(starts(server.now.segmentation)).toEqual([0, 40, 45, 60]);
    expect(edited.held.value).toBeNull();
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
    expect(edited.held.value).toBeNull();
    expect(server.got).toEqual([SPLIT]);
  });
});
