/** Show the lanes: activities, primitives, labels, and other results below them. */
import type { TargetedPointerEvent } from "preact";
import { useEffect, useMemo, useRef } from "preact/hooks";
import { useStore, type Drag, type Store } from "../store";
import {
  CLICK_TOLERANCE,
  Canvas,
  PlayheadLine,
  getPosition,
  getZoomFactor,
  moveFinger,
  type Pinch,
  type Touches,
} from "../drawing";
import { listen } from "../util";
import { formatPerson } from "../recordingData";
import { findIndexAt, getDuration, getSegmentName } from "../segments";
import { formatTime, toPixel, toSeconds } from "../view";
import { drawLanes, drawOverview } from "./timelineDrawing";
import {
  GUTTER_WIDTH,
  RULER_HEIGHT,
  findBorder,
  findLane,
  getBorderLimits,
  layOutLanes,
  type Lane,
} from "./lanes";

export function Timeline() {
  const store = useStore();
  const lanes = useRef<Lane[]>([]);
  const gestures = useMemo(() => new TimelineGestures(store, () => lanes.current), [store]);
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
            drawLanes(pen, lanes.current, store, width);
          }}
          gestures={gestures}
        />
        <Playhead handle />
      </div>
      <Overview />
      <SelectionStatus />
    </div>
  );
}

/** Show the playhead. It is no part of the canvas, so playing redraws no lanes. */
export function Playhead({ handle = false }: { handle?: boolean }) {
  const store = useStore();
  const share = toPixel(store.range.value, 1, store.playhead.value);
  return (
    <div class="playhead-room" style={{ left: `${GUTTER_WIDTH}px` }}>
      <PlayheadLine share={share} handle={handle} />
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
  const moveTo = (event: TargetedPointerEvent<HTMLCanvasElement>): void => {
    if (!event.currentTarget.hasPointerCapture(event.pointerId)) return;
    const { left, width } = event.currentTarget.getBoundingClientRect();
    const { start_s, stop_s } = store.range.value;
    const at = ((event.clientX - left) / width) * store.duration.value;
    if (store.zoom.value) store.panBy(at - (start_s + stop_s) / 2);
    else store.seek(at);
  };
  return (
    <div class="overview">
      <Canvas
        label="The whole recording; drag to choose what the lanes show."
        watch={() => {
          void [store.activities.value, store.labelColors.value];
          void [store.range.value, store.duration.value];
        }}
        draw={(pen, width, height) => drawOverview(pen, width, height, store)}
        onPointerDown={(event) => {
          event.currentTarget.setPointerCapture(event.pointerId);
          moveTo(event);
        }}
        onPointerMove={moveTo}
      />
    </div>
  );
}

const MOUSE_REACH = 5; // pixels to either side of a border
const TOUCH_REACH = 12;
const MIN_SEGMENT_WIDTH = 6; // pixels that a dragged border leaves of a segment

/** A position on the canvas, and how far away a border may be. */
interface Spot {
  x: number;
  y: number;
  width: number;
  reach: number;
}

/** A border within reach of a press. */
interface BorderGrip {
  lane: Lane;
  drag: Drag;
}

/** What the pressed pointers do. */
type Gesture =
  | { what: "scrub" }
  | { what: "press"; spot: Spot; border: BorderGrip | null }
  | { what: "pan"; last: number }
  | { what: "pinch" }
  | ({ what: "border"; x: number } & BorderGrip);

export class TimelineGestures {
  private gesture: Gesture | null = null;
  private readonly touches: Touches = new Map();

  constructor(
    private readonly store: Store,
    private readonly lanes: () => readonly Lane[] = () => [],
  ) {}

  down(event: PointerEvent): void {
    if (event.button !== 0) return;
    const spot = getSpot(event);
    (event.currentTarget as Element).setPointerCapture(event.pointerId);
    this.touches.set(event.pointerId, spot);
    if (this.touches.size > 1) {
      this.store.drag.value = null;
      this.gesture = { what: "pinch" };
      return;
    }
    if (spot.y < RULER_HEIGHT) {
      this.gesture = { what: "scrub" };
      this.store.seek(this.getSecondsAt(spot));
    } else this.gesture = { what: "press", spot, border: this.findBorder(spot) };
  }

  move(event: PointerEvent): void {
    const spot = getSpot(event);
    const pinch = moveFinger(this.touches, event.pointerId, spot);
    if (pinch) this.applyPinch(pinch, spot);
    const pressed = this.gesture;
    if (pressed?.what === "press" && Math.abs(spot.x - pressed.spot.x) > CLICK_TOLERANCE) {
      const { border } = pressed;
      const { x } = pressed.spot;
      this.gesture = border ? { what: "border", x, ...border } : { what: "pan", last: x };
    }
    const { gesture } = this;
    if (gesture?.what === "scrub") this.store.seek(this.getSecondsAt(spot));
    else if (gesture?.what === "pan") {
      this.store.panBy(this.getSecondsPerPixel(spot) * (gesture.last - spot.x));
      gesture.last = spot.x;
    } else if (gesture?.what === "border") {
      const perPixel = this.getSecondsPerPixel(spot) * this.store.fps.value;
      const least = Math.max(Math.ceil(perPixel * MIN_SEGMENT_WIDTH), 1);
      const { frame } = gesture.drag;
      const [low, high] = getBorderLimits(gesture.lane.segments, frame, least);
      const to = Math.round(frame + perPixel * (spot.x - gesture.x));
      gesture.drag = { ...gesture.drag, to: Math.min(Math.max(to, low), high) };
      this.store.drag.value = gesture.drag;
      this.store.seek(gesture.drag.to / this.store.fps.value);
    } else if (!gesture) this.updateHover(event, spot);
  }

  up(event: PointerEvent): void {
    const { gesture } = this;
    this.touches.delete(event.pointerId);
    if (gesture?.what === "pinch" && this.touches.size) return;
    this.gesture = null;
    if (gesture?.what === "press") this.handleClick(gesture.spot);
    if (gesture?.what !== "border") return;
    const { frame, to } = gesture.drag;
    const { level } = gesture.lane;
    if (level && to !== frame) this.store.edit.value?.({ kind: "move_border", level, frame, to });
    else this.store.drag.value = null;
  }

  /** Cancel the drag of a border; return whether one was dragged. */
  cancelDrag(): boolean {
    const { gesture } = this;
    if (gesture?.what !== "border") return false;
    this.cancel();
    this.store.seek(gesture.drag.frame / this.store.fps.value);
    return true;
  }

  cancel(): void {
    this.touches.clear();
    this.gesture = null;
    this.store.drag.value = null;
  }

  leave(): void {
    this.store.hovered.value = null;
  }

  wheel(event: WheelEvent): void {
    const spot = getSpot(event);
    const sideways = event.shiftKey ? event.deltaY : event.deltaX;
    if (event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY))
      this.store.panBy(sideways * this.getSecondsPerPixel(spot));
    else this.store.zoomBy(getZoomFactor(event), this.getSecondsAt(spot));
  }

  /** Zoom around the midpoint of two fingers. */
  private applyPinch(pinch: Pinch, spot: Spot): void {
    const at = this.getSecondsAt({ ...spot, ...pinch.from });
    this.store.zoomBy(pinch.factor, at);
    this.store.panBy(at - this.getSecondsAt({ ...spot, ...pinch.to }));
  }

  private handleClick(spot: Spot): void {
    const segment = this.findSegment(spot);
    const { person = null, level = null } = findLane(this.lanes(), spot.y) ?? {};
    if (person !== null) this.store.show(person);
    if (segment && (level || person !== null)) this.store.select(segment);
    // A click on the name only activates the person.
    else if (person === null || spot.x >= GUTTER_WIDTH)
      this.store.seek(segment?.start_s ?? this.getSecondsAt(spot));
  }

  private updateHover(event: PointerEvent, spot: Spot): void {
    const segment = this.findSegment(spot);
    const isInFront = (findLane(this.lanes(), spot.y)?.person ?? null) === null;
    this.store.hovered.value =
      segment && isInFront && segment.cluster >= 0 ? segment.cluster : null;
    const cursor =
      spot.y < RULER_HEIGHT || this.findBorder(spot) ? "ew-resize" : segment ? "pointer" : "";
    (event.currentTarget as HTMLElement).style.cursor = cursor;
  }

  private findSegment(spot: Spot): Lane["segments"][number] | undefined {
    const lane = findLane(this.lanes(), spot.y);
    if (!lane || spot.x < GUTTER_WIDTH) return undefined;
    const seconds = this.getSecondsAt(spot);
    const segment = lane.segments[findIndexAt(lane.segments, this.store.getFrameAt(seconds))];
    return segment && seconds < segment.stop_s && seconds >= segment.start_s ? segment : undefined;
  }

  private findBorder(spot: Spot): BorderGrip | null {
    const lane = findLane(this.lanes(), spot.y);
    if (!this.store.edit.value || !lane?.level || spot.x < GUTTER_WIDTH) return null;
    const reach = spot.reach * this.getSecondsPerPixel(spot);
    const frame = findBorder(lane.segments, this.getSecondsAt(spot), reach, this.store.fps.value);
    return frame === null ? null : { lane, drag: { lane: lane.id, frame, to: frame } };
  }

  private getSecondsAt({ x, width }: Spot): number {
    return toSeconds(this.store.range.value, width - GUTTER_WIDTH, x - GUTTER_WIDTH);
  }

  private getSecondsPerPixel({ width }: Spot): number {
    const { start_s, stop_s } = this.store.range.value;
    return (stop_s - start_s) / (width - GUTTER_WIDTH);
  }
}

function getSpot(event: PointerEvent | WheelEvent): Spot {
  const { width } = (event.currentTarget as Element).getBoundingClientRect();
  const reach = "pointerType" in event && event.pointerType === "touch" ? TOUCH_REACH : MOUSE_REACH;
  return { ...getPosition(event), width, reach };
}
