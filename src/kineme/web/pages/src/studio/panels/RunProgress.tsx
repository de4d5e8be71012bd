/** Show a segmentation's progress, with a button to cancel. */
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect } from "preact/hooks";
import type { Progress } from "../../messages";
import { useStudio } from "../context";
import { Button } from "../../layout/controls";

const PAUSE = 400; // milliseconds between requests and before the first

export function RunProgress({ id }: { id: string }): JSX.Element | null {
  const { session } = useStudio();
  const progress = useSignal<Progress | null>(null);
  useEffect(() => {
    const timer = window.setInterval(() => {
      void session.api.loadProgress(id).then(
        (now) => (progress.value = now),
        () => undefined, // the page reports this already
      );
    }, PAUSE);
    return () => window.clearInterval(timer);
  }, [session, id, progress]);
  if (!progress.value?.stage) return null;
  const { stage, share } = progress.value;
  const text = share === null ? stage : `${stage}, ${Math.round(100 * share)} %`;
  return (
    <div class="run-progress">
      <progress aria-label="Segmentation" value={share ?? undefined} />
      <Button title="What is there stays (Escape)" onClick={() => session.cancel()}>
        Cancel
      </Button>
      <span class="quiet">{text}</span>
    </div>
  );
}
