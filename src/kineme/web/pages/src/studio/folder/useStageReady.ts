/** Delay the 3-D stage, whose setup blocks a page for half a second. */
import { useSignal, useSignalEffect, type ReadonlySignal } from "@preact/signals";
import { useStudio } from "../context";
import { readOpenIds } from "../server/address";

const DRAW_DELAY = 300; // milliseconds for drawing the folder's rows first

/** Return whether to set up the stage: at once if a recording opens, else after the folder page. */
export function useStageReady(): ReadonlySignal<boolean> {
  const { session, review } = useStudio();
  const isReady = useSignal(readOpenIds().length > 0);
  useSignalEffect(() => {
    if (isReady.value) return;
    const opens = session.opening.value !== null || session.store.opened.value.length > 0;
    if (opens) isReady.value = true;
    else if (review.folder.isReady.value) setTimeout(() => (isReady.value = true), DRAW_DELAY);
  });
  return isReady;
}
