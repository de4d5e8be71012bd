/** Show the current place of the folder's review queue below the figure. */
import type { JSX } from "preact";
import { ReviewButtons } from "../review/ReviewButtons";
import { useStudio } from "../context";
import { getSegmentName } from "../../segments";
import { formatTime } from "../../view";
import { FolderProgress } from "./FolderProgress";
import { CloseButton } from "../../layout/controls";

export function QueueBar(): JSX.Element | null {
  const { session, review } = useStudio();
  const { current } = review.queue;
  if (!review.everywhere.value) return null;
  const place = current.value;
  const here = place?.id === session.store.recording.value?.id;
  return (
    <section class="queue-bar" aria-label="Review of all recordings">
      <p class="queue-why" role="status">
        {place ? (
          <>
            <strong>
              {place.recording}, {formatTime(place.doubt.segment.start_s, 2)}:{" "}
              {getSegmentName(place.doubt.segment)}.
            </strong>{" "}
            {here ? place.doubt.confidence.why : "Opening…"}
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
          onClick={() => void review.setEverywhere(false)}
        />
      </span>
    </section>
  );
}
