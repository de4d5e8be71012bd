/** Show the lanes: activities, primitives, labels, and other results below them. */
import { useEffect, useMemo, useRef } from "preact/hooks";
import { useStore, type Store } from "../store";
import { Canvas, PlayheadLine } from "../canvas/Canvas";
import { listen } from "../util";
import { formatPerson } from "../recordingData";
import { getDuration, getSegmentName } from "../segments";
import { formatTime, toPixel } from "../view";
import { drawLanes } from "./drawing";
import { TimelineGestures } from "./gestures";
import { GUTTER_WIDTH, layOutLanes, type Lane } from "./lanes";
import { readColor } from "../theme";

export function Timeline() {
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
      index: store.findIndex(value.id),
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
function Playhead() {
  const store = useStore();
  const share = toPixel(store.range.value, 1, store.playhead.value);
  return (
    <div class="playhead-room" style={{ left: `${GUTTER_WIDTH}px` }}>
      <PlayheadLine share={share} handle />
    </div>
  );
}

/** Announce the selection to screen readers. */
function SelectionStatus() {
  const store = useStore();
  const segment = store.selected.value;
  return (
    <p class="unseen" role="status">
      {segment &&
        `${segment.level} ${getSegmentName(segment)}, from ${formatTime(segment.start_s, 2)}, ${getDuration(segment).toFixed(2)} seconds`}
    </p>
  );
}

/** Show the whole recording and the visible range; drag to move the range or to seek. */
function Overview() {
  const store = useStore();
  const dragging = useRef(false);
  const moveTo = (event: PointerEvent): void => {
    const { left, width } = (event.currentTarget as Element).getBoundingClientRect();
    const { start_s, stop_s } = store.range.value;
    const at = ((event.clientX - left) / width) * store.duration.value;
    if (store.zoom.value) store.panBy(at - (start_s + stop_s) / 2);
    else store.seek(at);
  };
  return (
    <div class="overview">
      <Canvas
        label="The whole recording; drag to choose what the lanes show."
        watch={() =>
          void [
            store.activities.value,
            store.labelColors.value,
            store.range.value,
            store.duration.value,
          ]
        }
        draw={(pen, width, height) => drawOverview(pen, width, height, store)}
        onPointerDown={(event) => {
          event.currentTarget.setPointerCapture(event.pointerId);
          dragging.current = true;
          moveTo(event);
        }}
        onPointerMove={(event) => dragging.current && moveTo(event)}
        onPointerUp={() => (dragging.current = false)}
        onPointerCancel={() => (dragging.current = false)}
      />
    </div>
  );
}

function drawOverview(
  pen: CanvasRenderingContext2D,
  width: number,
  height: number,
  store: Store,
): void {
  const recording = { start_s: 0, stop_s: store.duration.value };
  pen.fillStyle = readColor("lane");
  pen.fillRect(0, 0, width, height);
  for (const segment of store.activities.value) {
    const { start_s, stop_s } = segment;
    const color = store.getColor(segment);
    if (!color) continue;
    const left = toPixel(recording, width, start_s);
    pen.fillStyle = color;
    pen.fillRect(left, 2, Math.max(toPixel(recording, width, stop_s) - left, 0.5), height - 4);
  }
  const { start_s, stop_s } = store.range.value;
  const left = toPixel(recording, width, start_s);
  const right = toPixel(recording, width, stop_s);
  pen.globalAlpha = 0.6;
  pen.fillStyle = readColor("page");
  pen.fillRect(0, 0, left, height);
  pen.fillRect(right, 0, width - right, height);
  pen.globalAlpha = 1;
  pen.strokeStyle = readColor("quiet");
  pen.strokeRect(left + 0.5, 0.5, Math.max(right - left - 1, 2), height - 1);
}
