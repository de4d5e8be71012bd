/** Under the figure: what of the folder is looked at, why, and how far one is. */
import type { JSX } from "preact";
import { ReviewButtons } from "../review/ReviewButtons";
import { useStudio } from "../context";
import { nameOf } from "../../segments";
import { clock } from "../../view";
import { FolderProgress } from "./FolderProgress";
import { CloseButton } from "../../layout/controls";

export function QueueBar(): JSX.Element | null {
  const { session, review } = useStudio();
  const { looking } = review.queue;
  if (!review.everywhere.value) return null;
  const place = looking.value;
  const here = place?.id === session.store.recording.value?.id;
  return (
    <section class="queue-bar" aria-label="Review of all recordings">
      <p class="queue-why" role="status">
        {place ? (
          <>
            <strong>
              {place.recording}, {clock(place.doubt.segment.start_s, 2)}:{" "}
              {nameOf(place.doubt.segment)}.
            </strong>{" "}
            {here ? place.doubt.why : "Opening…"}
          </>
        ) : (
          "Every segment of every recording is checked."
        )}
      </p>
      <FolderProgress tally={review.folder.tally.value} />
      <span class="group">
        <ReviewButtons />
        <CloseButton
          label="Leave the queue of the folder"
          onClick={() => void review.goEverywhere(false)}
        />
      </span>
    </section>
  );
}
