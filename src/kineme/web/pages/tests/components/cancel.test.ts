import { expect, it } from "vitest";
import type { State } from "../../src/messages";
import { Store } from "../../src/store";
import { type Api, Refused } from "../../src/studio/server/api";
import { Session } from "../../src/studio/session";
import { createBrief, listing } from "../studio/briefs";
import { recording } from "../studio/tables";

/** Open a session whose recording is still being read or segmented. */
async function openSession(
  being_read: boolean,
): Promise<{ session: Session; cancelled: string[] }> {
  const cancelled: string[] = [];
  const now = { ...recording(), finding: true, being_read };
  const listed = listing("take", createBrief(now.segmentation));
  const api = {
    loadState: () => Promise.resolve({ folder: "", recordings: [listed] } as unknown as State),
    loadRecording: () => Promise.resolve(now),
    cancel: (id: string) => Promise.resolve(void cancelled.push(id)),
  };
  const session = new Session(api as unknown as Api, new Store());
  await session.refresh();
  await session.open("take");
  return { session, cancelled };
}

it("closes what is still being read, and says so to the server", async () => {
  const { session, cancelled } = await openSession(true);
  session.cancel();
  expect(cancelled).toEqual(["take"]);
  expect(session.store.recording.value).toBeUndefined();
  expect(session.recordings.value).toEqual([]);
});

it("leaves open what only has no segments yet", async () => {
  const { session, cancelled } = await openSession(false);
  session.cancel();
  expect(cancelled).toEqual(["take"]);
  expect(session.store.recording.value?.id).toBe("take");
});

it("says nothing of a file that nobody waits for any more", async () => {
  const { session } = await openSession(false);
  session.api.loadRecording = () =>
    Promise.reject(new Refused(400, "It is broken.", { reading: true }));
  const opening = session.open("other");
  session.stopOpening();
  await opening;
  expect(session.notifications.problems.value).toEqual([]);
  expect(session.unread.value).toBeNull();
  expect(session.store.recording.value?.id).toBe("take");
});
