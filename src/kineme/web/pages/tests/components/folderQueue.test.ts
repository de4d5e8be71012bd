import { expect, it } from "vitest";
import type { BriefTable, FolderTables, State } from "../../src/messages";
import { Store } from "../../src/store";
import { unpackTable } from "../../src/studio/folder/briefTables";
import { Folder } from "../../src/studio/folder/folder";
import { FolderQueue } from "../../src/studio/review/review";
import type { Api } from "../../src/studio/server/api";
import { Session } from "../../src/studio/session";
import { brief, createBrief, listing } from "../studio/briefs";
import { Server } from "../studio/server";
import { recording } from "../studio/tables";

/** Create a server of several recordings that accept edits. */
function createFolder(tables: Record<string, BriefTable>): { session: Session; folder: Folder } {
  const servers = new Map(
    Object.entries(tables).map(([id, table]) => {
      const now = { ...recording(unpackTable(table)), id, name: `${id}.bvh` };
      return [id, new Server(now)];
    }),
  );
  const briefs = (): [string, BriefTable][] =>
    [...servers].map(([id, { now }]) => [id, createBrief(now.segmentation)]);
  const api = {
    loadState: () =>
      Promise.resolve({
        folder: "",
        recordings: briefs().map(([id, table]) => listing(id, table)),
      } as unknown as State),
    loadTables: (): Promise<FolderTables> =>
      Promise.resolve({ recordings: briefs().map(([id, table]) => ({ id, table })) }),
    loadRecording: (id: string) => servers.get(id)!.loadRecording(),
    sendEdit: (id: string, request: Parameters<Server["sendEdit"]>[1]) =>
      servers.get(id)!.sendEdit(id, request),
  };
  const session = new Session(api as unknown as Api, new Store());
  return { session, folder: new Folder(session) };
}

it("goes through all recordings, the least sure place first, whatever is edited", async () => {
  const { session, folder } = createFolder({ a: brief(0.6), b: brief(0.2), c: brief(0.4) });
  await session.refresh();
  const queue = new FolderQueue(folder);
  await queue.goToNext();
  expect([session.store.recording.value?.id, session.store.frame.value]).toEqual(["b", 40]);
  const why = queue.current.value?.doubt.confidence.why;
  const edited = session.edited.value!;
  await edited.edit({ kind: "name_segment", level: "activity", frame: 40, label: "jump" });
  expect(queue.current.value?.doubt.confidence.why).toBe(why);
  await edited.edit({ kind: "check", level: "activity", frames: [40], checked: true });
  expect(folder.tally.value).toEqual({ all: 6, checked: 1, doubtful: 1 });
  await queue.goToNext();
  expect(session.store.recording.value?.id).toBe("c");
  expect(folder.tally.value.checked).toBe(1); // the recording is closed
  await queue.goToNext();
  expect(session.store.recording.value?.id).toBe("a");
});

it("passes over what was moved, too", async () => {
  const { session, folder } = createFolder({ a: brief(0.2), b: brief(0.3) });
  await session.refresh();
  const queue = new FolderQueue(folder);
  await queue.goToNext();
  await session.edited.value!.edit({ kind: "move_border", level: "activity", frame: 40, to: 45 });
  session.store.seek(4.5);
  await queue.goToNext();
  expect(session.store.recording.value?.id).toBe("b");
});
