/** Show what to review next and the progress. */
import type { ComponentChildren } from "preact";
import { useStudio } from "../context";
import { getClusterColor } from "../../colors";
import type { Segment } from "../../messages";
import type { Place } from "./review";
import { getSegmentKey, getSegmentName } from "../../segments";
import { formatTime } from "../../view";
import { countProgress, type Doubt } from "../../confidence";
import { Button, Select, Swatch, CloseButton } from "../../layout/controls";
import type { Tally } from "../folder/briefTables";

const MAX_ROWS = 100; // rows; the rest follows when these are checked

export function ReviewPanel() {
  const { session, review } = useStudio();
  const { store } = session;
  const table = store.table.value;
  if (!table) return <p class="hint quiet">Open a recording to look through its segments.</p>;
  const doubts = review.doubts.value;
  const present = review.present.value;
  const several = (session.state.value?.recordings.length ?? 0) > 1;
  const scope = several && (
    <label class="field">
      Look through{" "}
      <Select
        value={review.everywhere.value ? "folder" : "recording"}
        options={[
          ["recording", "this recording"],
          ["folder", "all recordings"],
        ]}
        onSelect={(chosen) => void review.setEverywhere(chosen === "folder")}
      />
    </label>
  );
  if (review.everywhere.value) return <FolderReview scope={scope} />;
  return (
    <div class="review-panel">
      {scope}
      <Progress title="Activities" of={countProgress(table, "activity")} />
      <Progress title="Primitives" of={countProgress(table, "primitive")} />
      <p class="actions">
        <ReviewButtons />
      </p>
      <p class="why" role="status">
        {present
          ? present.confidence.why
          : doubts.length
            ? "“Next” goes to where confidence is lowest."
            : "Every segment of this recording is checked."}
      </p>
      <DoubtList
        places={doubts.map((doubt) => ({ doubt }))}
        isCurrent={({ doubt }) => doubt === present}
        getColor={(segment) => store.getColor(segment)}
        go={({ doubt }) => store.showSegment(doubt.segment)}
      />
    </div>
  );
}

/** List what to review in all recordings; the bar below the figure has the details. */
function FolderReview({ scope }: { scope: ComponentChildren }) {
  const { review } = useStudio();
  const { folder, queue } = review;
  const without = folder.unsegmented.value.length;
  return (
    <div class="review-panel">
      {scope}
      <DoubtList
        places={queue.places.value}
        isCurrent={(place) => place === queue.current.value}
        getColor={({ cluster }) => getClusterColor(cluster)}
        go={(place) => void queue.goTo(place)}
      />
      {without > 0 && <p class="quiet note">{without} recordings are not segmented yet</p>}
    </div>
  );
}

/** List segments to review; a click goes there. */
function DoubtList<Item extends Partial<Place> & { doubt: Doubt }>(props: {
  places: readonly Item[];
  isCurrent: (place: Item) => boolean;
  getColor: (segment: Segment) => string | null;
  go: (place: Item) => void;
}) {
  const { places, isCurrent, getColor, go } = props;
  return (
    <>
      <ol class="doubts">
        {places.slice(0, MAX_ROWS).map((place) => {
          const { segment, confidence } = place.doubt;
          return (
            <li key={`${place.id} ${getSegmentKey(segment)}`}>
              <Button
                class="plain"
                aria-current={isCurrent(place) ? "true" : undefined}
                title={confidence.why}
                onClick={() => go(place)}
              >
                <Swatch color={getColor(segment)} />
                <span class="name">
                  {getSegmentName(segment)} <span class="quiet">{segment.level}</span>
                </span>
                <span class="number quiet">{formatTime(segment.start_s, 2)}</span>
                <span class="number">{confidence.short || "–"}</span>
                {place.recording && <span class="of quiet">{place.recording}</span>}
              </Button>
            </li>
          );
        })}
      </ol>
      {places.length > MAX_ROWS && <p class="quiet note">and {places.length - MAX_ROWS} more</p>}
    </>
  );
}

function Progress({ title, of: [checked, all] }: { title: string; of: [number, number] }) {
  if (!all) return null;
  return (
    <p class="progress">
      <span>{title}</span>
      <progress max={all} value={checked} aria-label={`${title} checked`} />
      <span class="number">
        {checked} of {all}
      </span>
    </p>
  );
}

/** Go to the next segment to review, optionally marking the current one. */
function ReviewButtons() {
  const { review } = useStudio();
  return (
    <>
      <Button title="Next to look at (J)" onClick={() => void review.goToNext()}>
        Next
      </Button>
      <Button
        class="primary"
        title="The segment is right: mark it and go on (K)"
        onClick={() => review.checkAndGoOn()}
      >
        Checked, next
      </Button>
    </>
  );
}

/** Show the current place of the folder's review queue below the figure. */
export function QueueBar() {
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

/** Show progress such as "312 of 1,396 checked; 40 of the others below 50 %". */
export function FolderProgress({ tally }: { tally: Tally }) {
  const { all, checked, doubtful } = tally;
  if (!all) return null;
  return (
    <p class="folder-progress">
      <progress max={all} value={checked} aria-label="Segments of the folder checked" />
      <span
        class="number"
        title="Segments that nobody checked and that are more probably wrong than right"
      >
        {checked.toLocaleString("en")} of {all.toLocaleString("en")} checked;{" "}
        {doubtful.toLocaleString("en")} of the others below 50 %
      </span>
    </p>
  );
}
