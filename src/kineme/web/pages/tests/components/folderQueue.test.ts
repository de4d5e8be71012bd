// @vitest-environment happy-dom
import "./offscreen";
import { expect, it } from "vitest";
import type { BriefTable, FolderTables, State } from "../../src/messages";
import { Store } from "../../src/store";
import { tableOf } from "../../src/studio/folder/briefTables";
import { Folder } from "../../src/studio/folder/folder";
import { FolderQueue } from "../../src/studio/folder/folderQueue";
import type { Api } from "../../src/studio/server/api";
import { Session } from "../../src/studio/session";
import { brief, briefOf, listing } from "../studio/briefs";
import { Server } from "../studio/server";
import { recording } from "../studio/tables";
import "./browser";

/** A server of several recordings, each of which takes edits. */
function folderOf(tables: Record<string, BriefTable>): { session: Session; folder: Folder } {
  const servers = new Map(
    Object.entries(tables).map(([id, table]) => {
      const now = { ...recording(tableOf(table)), id, name: `${id}.bvh` };
      return [id, new Server(now)];
    }),
  );
  const briefs = (): [string, BriefTable][] =>
    [...servers].map(([id, { now }]) => [id, briefOf(now.segmentation)]);
  const api = {
    state: () =>
      Promise.resolve({
        folder: "",
        recordings: briefs().map(([id, table]) => listing(id, table)),
      } as unknown as State),
    tables: (): Promise<FolderTables> =>
      Promise.resolve({ recordings: briefs().map(([id, table]) => ({ id, table })) }),
    recording: (id: string) => servers.get(id)!.recording(),
    edit: (id: string, request: Parameters<Server["edit"]>[1]) =>
      servers.get(id)!.edit(id, request),
  };
  const session = new Session(api as unknown as Api, new Store());
  return { session, folder: new Folder(session) };
}

it("goes through all recordings, the least sure place first, whatever is edited", async () => {
  const { session, folder } = folderOf({ a: brief(0.6), b: brief(0.2), c: brief(0.4) });
  await session.refresh();
  const queue = new FolderQueue(folder);
  await queue.next();
  expect([session.store.recording.value?.id, session.store.frame.value]).toEqual(["b", 40]);
  const why = queue.looking.value?.doubt.why;
  const edited = session.edited.value!;
  await edited.edit({ kind: "name_segment", level: "activity", frame: 40, label: "jump" });
  expect(queue.looking.value?.doubt.why).toBe(why);
  await edited.edit({ kind: "check", level: "activity", frames: [40], checked: true });
  expect(folder.tally.value).toEqual({ all: 6, checked: 1, doubtful: 1 });
  await queue.next();
  expect(session.store.recording.value?.id).toBe("c");
  expect(folder.tally.value.checked).toBe(1); // of one that is not open any more
  await queue.next();
  expect(session.store.recording.value?.id).toBe("a");
});

it("passes over what was moved, too", async () => {
  const { session, folder } = folderOf({ a: brief(0.2), b: brief(0.3) });
  await session.refresh();
  const queue = new FolderQueue(folder);
  await queue.next();
  await session.edited.value!.edit({ kind: "move_border", level: "activity", frame: 40, to: 45 });
  session.store.seek(4.5);
  await queue.next();
  expect(session.store.recording.value?.id).toBe("b");
});
