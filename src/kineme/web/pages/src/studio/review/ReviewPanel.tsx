/** What to look at next, why, and how far one is. */
import type { ComponentChildren, JSX } from "preact";
import { ReviewButtons } from "./ReviewButtons";
import { useStudio } from "../context";
import { clusterColor, NO_COLOR } from "../../colors";
import type { Level } from "../../messages";
import { nameOf } from "../../segments";
import { clock } from "../../view";
import { progressOf, type Doubt } from "./doubts";
import { keyOf } from "./review";
import { Button, Select } from "../../layout/controls";

const MOST = 100; // rows; the rest comes when these are checked

export function ReviewPanel(): JSX.Element {
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
        onSelect={(chosen) => void review.goEverywhere(chosen === "folder")}
      />
    </label>
  );
  if (review.everywhere.value) return <FolderReview scope={scope} />;
  return (
    <div class="review-panel">
      {scope}
      <Progress level="activity" title="Activities" of={progressOf(table, "activity")} />
      <Progress level="primitive" title="Primitives" of={progressOf(table, "primitive")} />
      <p class="actions">
        <ReviewButtons />
      </p>
      <p class="why" role="status">
        {present
          ? present.why
          : doubts.length
            ? "“Next” goes to where confidence is lowest."
            : "Every segment of this recording is checked."}
      </p>
      <ol class="doubts">
        {doubts.slice(0, MOST).map((doubt) => (
          <Item
            key={keyOf(doubt.segment)}
            doubt={doubt}
            color={store.colorOf(doubt.segment) ?? NO_COLOR}
            current={doubt === present}
            go={() => review.go(doubt)}
          />
        ))}
      </ol>
      {doubts.length > MOST && <p class="quiet note">and {doubts.length - MOST} more</p>}
    </div>
  );
}

/** The same of all recordings; what is under the figure has why, and goes on. */
function FolderReview({ scope }: { scope: ComponentChildren }): JSX.Element {
  const { review } = useStudio();
  const { folder, queue } = review;
  const { value: places } = queue.places;
  const without = folder.without.value.length;
  return (
    <div class="review-panel">
      {scope}
      <ol class="doubts">
        {places.slice(0, MOST).map((place) => (
          <Item
            key={`${place.id} ${keyOf(place.doubt.segment)}`}
            doubt={place.doubt}
            color={clusterColor(place.doubt.segment.cluster)}
            current={place === queue.looking.value}
            go={() => void queue.go(place)}
          >
            <span class="of quiet">{place.recording}</span>
          </Item>
        ))}
      </ol>
      {places.length > MOST && <p class="quiet note">and {places.length - MOST} more</p>}
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

/** A segment to look at; a click goes there. */
function Item({ doubt, color, current, go, children }: ItemProps): JSX.Element {
  const { segment, short, why } = doubt;
  return (
    <li>
      <Button class="plain" aria-current={current ? "true" : undefined} title={why} onClick={go}>
        <span class="swatch" style={{ background: color }} />
        <span class="name">
          {nameOf(segment)} <span class="quiet">{segment.level}</span>
        </span>
        <span class="number quiet">{clock(segment.start_s, 2)}</span>
        <span class="number">{short || "–"}</span>
        {children}
      </Button>
    </li>
  );
}

function Progress(props: {
  level: Level;
  title: string;
  of: [number, number];
}): JSX.Element | null {
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
