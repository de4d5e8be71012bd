/** Which recording is being read, for how long, and the button that stops waiting for it. */
import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import type { JSX } from "preact";
import { useStudio } from "../context";
import { megabytes } from "./FolderPanel";
import { Button } from "../../layout/controls";

export function Opening(): JSX.Element | null {
  const { session } = useStudio();
  const id = session.opening.value;
  const listing = session.state.value?.recordings.find((each) => each.id === id);
  const seconds = useSignal(0);
  useEffect(() => {
    seconds.value = 0;
    const timer = window.setInterval(() => (seconds.value += 1), 1000);
    return () => window.clearInterval(timer);
  }, [id, seconds]);
  if (!listing || seconds.value === 0) return null; // most recordings are there at once
  return (
    <p class="opening">
      Reading {listing.name}, {megabytes(listing.bytes)}: {seconds.value} s{" "}
      <Button onClick={() => session.stopOpening()}>Cancel</Button>
    </p>
  );
}
