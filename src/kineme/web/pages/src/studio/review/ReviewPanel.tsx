/** Show what to review next and the progress. */
import type { ComponentChildren } from "preact";
import { useStudio } from "../context";
import { getClusterColor, NO_COLOR } from "../../colors";
import type { Level } from "../../messages";
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
      <Progress level="activity" title="Activities" of={countProgress(table, "activity")} />
      <Progress level="primitive" title="Primitives" of={countProgress(table, "primitive")} />
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
      <ol class="doubts">
        {doubts.slice(0, MAX_ROWS).map((doubt) => (
          <DoubtItem
            key={getSegmentKey(doubt.segment)}
            doubt={doubt}
            color={store.getColor(doubt.segment) ?? NO_COLOR}
            current={doubt === present}
            go={() => review.goTo(doubt)}
          />
        ))}
      </ol>
      {doubts.length > MAX_ROWS && <p class="quiet note">and {doubts.length - MAX_ROWS} more</p>}
    </div>
  );
}

/** List what to review in all recordings; the bar below the figure has the details. */
function FolderReview({ scope }: { scope: ComponentChildren }) {
  const { review } = useStudio();
  const { folder, queue } = review;
  const { value: places } = queue.places;
  const without = folder.unsegmented.value.length;
  return (
    <div class="review-panel">
      {scope}
      <ol class="doubts">
        {places.slice(0, MAX_ROWS).map((place) => (
          <DoubtItem
            key={`${place.id} ${getSegmentKey(place.doubt.segment)}`}
            doubt={place.doubt}
            color={getClusterColor(place.doubt.segment.cluster)}
            current={place === queue.current.value}
            go={() => void queue.goTo(place)}
          >
            <span class="of quiet">{place.recording}</span>
          </DoubtItem>
        ))}
      </ol>
      {places.length > MAX_ROWS && <p class="quiet note">and {places.length - MAX_ROWS} more</p>}
      {without > 0 && <p class="quiet note">{without} recordings are not segmented yet</p>}
    </div>
  );
}

interface ItemProps {
  doubt: Doubt;
  color: string;
  current: boolean;
  go: () => void;
  children?: ComponentChildren;
}

/** Show a segment to review; a click goes there. */
function DoubtItem({ doubt, color, current, go, children }: ItemProps) {
  const { segment, confidence } = doubt;
  return (
    <li>
      <Button
        class="plain"
        aria-current={current ? "true" : undefined}
        title={confidence.why}
        onClick={go}
      >
        <Swatch color={color} />
        <span class="name">
          {getSegmentName(segment)} <span class="quiet">{segment.level}</span>
        </span>
        <span class="number quiet">{formatTime(segment.start_s, 2)}</span>
        <span class="number">{confidence.short || "–"}</span>
        {children}
      </Button>
    </li>
  );
}

function Progress(props: { level: Level; title: string; of: [number, number] }) {
  const { title, of } = props;
  const [checked, all] = of;
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
        {formatInteger(checked)} of {formatInteger(all)} checked; {formatInteger(doubtful)} of the
        others below 50 %
      </span>
    </p>
  );
}

function formatInteger(n: number): string {
  return n.toLocaleString("en");
}
