/** Expose the studio's state as `window.kineme`, for tests. */
import { createSnapshot } from "../snapshot";
import type { Session } from "./session";

export function exposeStudio(session: Session): void {
  const { store } = session;
  Object.defineProperty(window, "kineme", {
    get: () =>
      Object.freeze({
        ...createSnapshot(store),
        recordings: store.opened.value.map((opened) => opened.recording.value.name),
        segments: store.table.value?.segments ?? [],
        checked: (store.table.value?.segments ?? []).flatMap((row, i) => (row.checked ? [i] : [])),
        selected: store.selected.value ?? null,
        unsent: session.unsent.value,
      }),
  });
}
