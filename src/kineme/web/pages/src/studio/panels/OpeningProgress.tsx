/** Show which recording is loading, with a button to cancel. */
import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import type { JSX } from "preact";
import { useStudio } from "../context";
import { formatFileSize } from "./FolderPanel";
import { Button } from "../../layout/controls";

export function OpeningProgress(): JSX.Element | null {
  const { session } = useStudio();
  const id = session.opening.value;
  const listing = session.state.value?.recordings.find((each) => each.id === id);
  const seconds = useSignal(0);
  useEffect(() => {
    seconds.value = 0;
    const timer = window.setInterval(() => (seconds.value += 1), 1000);
    return () => window.clearInterval(timer);
  }, [id, seconds]);
  if (!listing || seconds.value === 0) return null; // most recordings open within a second
  return (
    <p class="opening">
      Reading {listing.name}, {formatFileSize(listing.bytes)}: {seconds.value} s{" "}
      <Button onClick={() => session.stopOpening()}>Cancel</Button>
    </p>
  );
}
