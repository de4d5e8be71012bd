/** The lanes: activities, primitives, labels, and other results below them. */
import { useEffect, useMemo, useRef } from "preact/hooks";
import type { JSX } from "preact";
import { useStore } from "../context";
import { Canvas } from "../canvas/Canvas";
import { Line } from "../canvas/Line";
import { personCalled } from "../opened";
import { durationOf, nameOf } from "../segments";
import { clock, toPixel } from "../view";
import { drawLanes } from "./drawing";
import { Gestures } from "./gestures";
import { GUTTER, layOut, type Lane } from "./lanes";
import { Overview } from "./Overview";

export function Timeline(): JSX.Element {
  const store = useStore();
  const lanes = useRef<Lane[]>([]);
  const gestures = useMemo(
    () =>
      new Gestures(
        store,
        () => lanes.current,
        (next) => void (store.drag.value = next),
      ),
    [store],
  );
  useEffect(() => {
    const onKey = (event: KeyboardEvent): void => {
      if (event.key === "Escape" && gestures.giveUp()) event.stopPropagation();
    };
    addEventListener("keydown", onKey, true);
    return () => removeEventListener("keydown", onKey, true);
  }, [gestures]);
  const given = (): Parameters<typeof layOut>[0] => ({
    activities: store.activities.value,
    primitives: store.primitives.value,
    labels: store.labels.value,
    others: store.others.value,
    people: store.people.value.map(({ recording: { value } }) => ({
      name: personCalled(value.person ?? value.name),
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
            void [given(), store.range.value, store.selected.value, store.hovered.value];
            void [store.loop.value, store.drag.value, store.target.value, store.border.value];
            void [store.bounds.value, store.labelColors.value, store.edit.value, store.table.value];
          }}
          draw={(pen, width, height) => {
            lanes.current = layOut(given(), height);
            drawLanes(pen, lanes.current, store, store.drag.value, width);
          }}
          gestures={gestures}
        />
        <Playhead />
      </div>
      <Overview />
      <Spoken />
    </div>
  );
}

/** The line of the present time; apart from the canvas, so that playing redraws no lanes. */
function Playhead(): JSX.Element {
  const store = useStore();
  const share = toPixel(store.range.value, 1, store.playhead.value);
  return (
    <div class="playhead-room" style={{ left: `${GUTTER}px` }}>
      <Line share={share} handle />
    </div>
  );
}

/** What is selected, for those who do not see it. */
function Spoken(): JSX.Element {
  const store = useStore();
  const segment = store.selected.value;
  return (
    <p class="unseen" role="status">
      {segment &&
        `${segment.level} ${nameOf(segment)}, from ${clock(segment.start_s, 2)}, ${durationOf(segment).toFixed(2)} seconds`}
    </p>
  );
}
