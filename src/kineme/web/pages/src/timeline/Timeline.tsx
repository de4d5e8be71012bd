/** Show the lanes: activities, primitives, labels, and other results below them. */
import { useEffect, useMemo, useRef } from "preact/hooks";
import type { JSX } from "preact";
import { useStore } from "../context";
import { Canvas } from "../canvas/Canvas";
import { PlayheadLine } from "../canvas/PlayheadLine";
import { listen } from "../layout/browser";
import { formatPerson } from "../openRecording";
import { getDuration, getSegmentName } from "../segments";
import { formatTime, toPixel } from "../view";
import { drawLanes } from "./drawing";
import { TimelineGestures } from "./gestures";
import { GUTTER_WIDTH, layOutLanes, type Lane } from "./lanes";
import { Overview } from "./Overview";

export function Timeline(): JSX.Element {
  const store = useStore();
  const lanes = useRef<Lane[]>([]);
  const gestures = useMemo(
    () =>
      new TimelineGestures(
        store,
        () => lanes.current,
        (next) => void (store.drag.value = next),
      ),
    [store],
  );
  useEffect(() => {
    const onKey = (event: KeyboardEvent): void => {
      if (event.key === "Escape" && gestures.cancelDrag()) event.stopPropagation();
    };
    return listen(window, { keydown: onKey }, { capture: true });
  }, [gestures]);
  const getLaneInput = (): Parameters<typeof layOutLanes>[0] => ({
    activities: store.activities.value,
    primitives: store.primitives.value,
    labels: store.labels.value,
    others: store.others.value,
    people: store.people.value.map(({ recording: { value } }) => ({
      name: formatPerson(value.person ?? value.name),
      index: store.opened.value.findIndex((each) => each.recording.value.id === value.id),
      segmentation: value.id === store.recording.value?.id ? null : value.segmentation,
    })),
  });
  return (
    <div class="timeline">
      <div class="lanes">
        <Canvas
          label="Segments over time. Click one to go there; use the wheel or two fingers to zoom, drag to pan."
          watch={() => {
            void [getLaneInput(), store.range.value, store.selected.value, store.hovered.value];
            void [store.loop.value, store.drag.value, store.target.value, store.border.value];
            void [store.bounds.value, store.labelColors.value, store.edit.value, store.table.value];
          }}
          draw={(pen, width, height) => {
            lanes.current = layOutLanes(getLaneInput(), height);
            drawLanes(pen, lanes.current, store, store.drag.value, width);
          }}
          gestures={gestures}
        />
        <Playhead />
      </div>
      <Overview />
      <SelectionStatus />
    </div>
  );
}

/** Show the playhead. It is no part of the canvas, so playing redraws no lanes. */
function Playhead(): JSX.Element {
  const store = useStore();
  const share = toPixel(store.range.value, 1, store.playhead.value);
  return (
    <div class="playhead-room" style={{ left: `${GUTTER_WIDTH}px` }}>
      <PlayheadLine share={share} handle />
    </div>
  );
}

/** Announce the selection to screen readers. */
function SelectionStatus(): JSX.Element {
  const store = useStore();
  const segment = store.selected.value;
  return (
    <p class="unseen" role="status">
      {segment &&
        `${segment.level} ${getSegmentName(segment)}, from ${formatTime(segment.start_s, 2)}, ${getDuration(segment).toFixed(2)} seconds`}
    </p>
  );
}
