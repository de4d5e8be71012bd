/** When it is the turn of the figure's stage, which takes a page half a second to set up. */
import { useSignal, useSignalEffect, type ReadonlySignal } from "@preact/signals";
import { useStudio } from "../context";
import { openInAddress } from "../server/address";

const REST = 300; // milliseconds in which the rows of the folder are drawn

/** At once where a recording comes, else after the folder's page. */
export function useStageTurn(): ReadonlySignal<boolean> {
  const { session, review } = useStudio();
  const turn = useSignal(openInAddress().length > 0);
  useSignalEffect(() => {
    if (turn.value) return;
    const opens = session.opening.value !== null || session.store.opened.value.length > 0;
    if (opens) turn.value = true;
    else if (review.folder.ready.value) setTimeout(() => (turn.value = true), REST);
  });
  return turn;
}
