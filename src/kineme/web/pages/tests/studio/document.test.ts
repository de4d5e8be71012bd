import { beforeEach, describe, expect, it, vi } from "vitest";
import type { Edit, Edited, EditRequest, Recording } from "../../src/messages";
import type { Api } from "../../src/studio/api";
import { recording, starts } from "./tables";

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

const { Refused, Unreachable } = await import("../../src/studio/api");
const { Document } = await import("../../src/studio/document");
const { preview } = await import("../../src/studio/preview");

const SPLIT: Edit = { kind: "split", level: "primitive", frame: 45 };
const MOVE: Edit = { kind: "move_border", level: "primitive", frame: 30, to: 40 };

/** A server that holds one table, can be switched off, and can die after it saved. */
class Server {
  now: Recording = recording();
  up = true;
  dieAfterSaving = false;
  readonly got: Edit[] = [];

  recording(): Promise<Recording> {
    return this.up ? Promise.resolve(this.now) : Promise.reject(new Unreachable());
  }

  async edit(_id: string, { revision, edit }: EditRequest): Promise<Edited> {
    if (!this.up) throw new Unreachable();
    if (revision !== this.now.revision) throw new Refused(409, "The table has changed.", {});
    if (edit.kind === "undo") throw new Refused(400, "There is nothing to undo.", {});
    this.got.push(edit);
    const segmentation = preview(this.now.segmentation, [edit]);
    this.now = { ...this.now, segmentation, revision: revision + 1, saved: "take.segments.json" };
    if (this.dieAfterSaving) {
      this.up = false;
      throw new Unreachable();
    }
    return { ...this.now, notes: [] };
  }
}

let server: Server;
let told: string[];
let lost: number;

function open(): Promise<InstanceType<typeof Document>> {
  return Document.open("take", {
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
  it("an edit is shown at once and confirmed soon after", async () => {
    const document = await open();
    document.edit(SPLIT);
    expect(starts(document.shown.value.segmentation)).toContain(45);
    expect(starts(document.confirmed.value.segmentation)).not.toContain(45);
    await settled();
    expect(starts(document.confirmed.value.segmentation)).toContain(45);
    expect(document.waiting.value).toEqual([]);
    expect(document.confirmed.value.saved).toBe("take.segments.json");
  });

  it("edits made faster than it answers are sent in order, each on the table before", async () => {
    const document = await open();
    document.edit(MOVE);
    document.edit(SPLIT);
    await settled();
    expect(server.got).toEqual([MOVE, SPLIT]);
    expect(document.confirmed.value.revision).toBe(2);
  });

  it("only the last of several waiting segmentations is asked for", async () => {
    const document = await open();
    for (const radius of [1, 2, 3])
      document.edit({ kind: "segment", preset: "kineme", parameters: { radius } });
    await settled();
    expect(server.got.map((edit) => edit.kind === "segment" && edit.parameters["radius"])).toEqual([
      1, 3,
    ]);
  });

  it("an edit that is refused for what it is goes, with the reason", async () => {
    const document = await open();
    document.edit({ kind: "undo" });
    document.edit(SPLIT);
    await settled();
    expect(told).toEqual(["There is nothing to undo."]);
    expect(server.got).toEqual([SPLIT]);
  });
});

it("as many edits are undone as undo was asked for, however fast", async () => {
  const document = await open();
  for (let i = 0; i < 4; i++) document.undo();
  expect(document.waiting.value.map(({ edit }) => edit.kind)).toEqual(Array(4).fill("undo"));
});

describe("when the server is gone", () => {
  it("edits wait, are shown, and are sent when it is back", async () => {
    const document = await open();
    server.up = false;
    document.edit(MOVE);
    document.edit(SPLIT);
    await settled();
    expect(lost).toBeGreaterThan(0);
    expect(document.unsent()).toHaveLength(2);
    expect(starts(document.shown.value.segmentation)).toEqual([0, 40, 45, 60]);
    server.up = true;
    server.now = { ...server.now, revision: 0 };
    await document.resume();
    expect(server.got).toEqual([MOVE, SPLIT]);
    expect(document.unsent()).toEqual([]);
  });

  it("an edit that was saved before the answer was lost is not made twice", async () => {
    const document = await open();
    server.dieAfterSaving = true;
    document.edit(MOVE);
    await settled();
    expect(document.unsent()).toHaveLength(1);
    server.dieAfterSaving = false;
    server.up = true;
    server.now = { ...server.now, revision: 0 }; // a new server counts anew
    await document.resume();
    expect(document.unsent()).toEqual([]);
    expect(document.held.value).toBeNull();
    expect(server.got).toEqual([MOVE]);
  });

  it("a tab that dies, too, leaves its edits to the next one", async () => {
    const document = await open();
    server.up = false;
    document.edit(MOVE);
    await settled();
    document.close();
    server.up = true;
    const next = await open();
    await settled();
    expect(starts(next.confirmed.value.segmentation)).toContain(40);
    expect(stored.size).toBe(0);
  });

  it("an undo takes back an edit that never left", async () => {
    const document = await open();
    server.up = false;
    document.edit(MOVE);
    document.edit(SPLIT);
    await settled();
    document.undo();
    expect(document.unsent()).toHaveLength(1);
  });
});

describe("when somebody else changes the table", () => {
  it("an edit of the old table is kept and made only when asked for", async () => {
    const document = await open();
    await server.edit("take", { revision: 0, edit: MOVE });
    document.edit(SPLIT);
    await settled();
    expect(document.held.value).toBe("The table has changed.");
    expect(document.unsent()).toHaveLength(1);
    expect(starts(document.confirmed.value.segmentation)).toEqual([0, 40, 60]);
    document.retry();
    await settled();
    expect(starts(server.now.segmentation)).toEqual([0, 40, 45, 60]);
    expect(document.held.value).toBeNull();
  });

  it("it can be dropped, too", async () => {
    const document = await open();
    await server.edit("take", { revision: 0, edit: MOVE });
    document.edit(SPLIT);
    await settled();
    document.drop();
    await settled();
    expect(starts(document.shown.value.segmentation)).toEqual([0, 40, 60]);
    expect(server.got).toEqual([MOVE]);
  });

  it("the table is loaded anew when the server tells", async () => {
    const document = await open();
    await server.edit("take", { revision: 0, edit: MOVE });
    await document.changed(1);
    expect(starts(document.shown.value.segmentation)).toEqual([0, 40, 60]);
    expect(told).toHaveLength(1);
  });

  it("a server that counts anew but has the same table just gets the edit", async () => {
    const document = await open();
    server.now = { ...server.now, revision: 7 };
    document.edit(SPLIT);
    await settled();
    expect(document.held.value).toBeNull();
    expect(server.got).toEqual([SPLIT]);
  });
});
