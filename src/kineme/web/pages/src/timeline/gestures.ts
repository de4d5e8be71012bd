/**
 * Handle pointers on the lanes: scrub, select, pan, drag a border, and zoom with two fingers. A
 * press that hardly moves selects, even next to a border; otherwise it drags the border.
 */
import {
  CLICK_TOLERANCE,
  TouchTracker,
  getPosition,
  getZoomFactor,
  type Pinch,
} from "../canvas/pointers";
import { findIndexAt } from "../segments";
import type { Drag, Store } from "../store";
import { toSeconds } from "../view";
import {
  findBorder,
  GUTTER_WIDTH,
  findLane,
  getBorderLimits,
  RULER_HEIGHT,
  type Lane,
} from "./lanes";

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

type Gesture =
  | { what: "scrub" }
  | { what: "press"; spot: Spot; border: BorderGrip | null }
  | { what: "pan"; last: number }
  | { what: "pinch" }
  | ({ what: "border"; x: number } & BorderGrip);

export class TimelineGestures {
  private gesture: Gesture | null = null;
  private readonly touches = new TouchTracker();

  constructor(
    private readonly store: Store,
    private readonly lanes: () => readonly Lane[],
    private readonly onDrag: (drag: Drag | null) => void,
  ) {}

  down(event: PointerEvent): void {
    if (event.button !== 0) return;
    const spot = getSpot(event);
    (event.currentTarget as Element).setPointerCapture(event.pointerId);
    this.touches.press(event.pointerId, spot);
    if (this.touches.count > 1) {
      this.onDrag(null);
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
    const pinch = this.touches.move(event.pointerId, spot);
    if (pinch) this.applyPinch(pinch, spot);
    if (
      this.gesture?.what === "press" &&
      Math.abs(spot.x - this.gesture.spot.x) > CLICK_TOLERANCE
    ) {
      const { border } = this.gesture;
      const { x } = this.gesture.spot;
      this.gesture = border ? { what: "border", x, ...border } : { what: "pan", last: x };
    }
    const { gesture } = this;
    if (gesture?.what === "scrub") this.store.seek(this.getSecondsAt(spot));
    else if (gesture?.what === "pan") {
      this.store.panBy(this.getSecondsAt({ ...spot, x: gesture.last }) - this.getSecondsAt(spot));
      gesture.last = spot.x;
    } else if (gesture?.what === "border") {
      const { start_s, stop_s } = this.store.range.value;
      const perPixel = ((stop_s - start_s) / (spot.width - GUTTER_WIDTH)) * this.store.fps.value;
      const least = Math.max(Math.ceil(perPixel * MIN_SEGMENT_WIDTH), 1);
      const { frame } = gesture.drag;
      const [low, high] = getBorderLimits(gesture.lane.segments, frame, least);
      const to = Math.round(frame + perPixel * (spot.x - gesture.x));
      gesture.drag = { ...gesture.drag, to: Math.min(Math.max(to, low), high) };
      this.onDrag(gesture.drag);
      this.store.seek(gesture.drag.to / this.store.fps.value);
    } else if (!gesture) this.updateHover(event, spot);
  }

  up(event: PointerEvent): void {
    const { gesture } = this;
    this.touches.lift(event.pointerId);
    if (gesture?.what === "pinch" && this.touches.count) return;
    this.gesture = null;
    if (gesture?.what === "press") this.handleClick(gesture.spot);
    if (gesture?.what !== "border") return;
    const { frame, to } = gesture.drag;
    const { level } = gesture.lane;
    if (level && to !== frame) this.store.edit.value?.({ kind: "move_border", level, frame, to });
    else this.onDrag(null);
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
    this.onDrag(null);
  }

  leave(): void {
    this.store.hovered.value = null;
  }

  wheel(event: WheelEvent): void {
    const spot = getSpot(event);
    const { start_s, stop_s } = this.store.range.value;
    const sideways = event.shiftKey ? event.deltaY : event.deltaX;
    if (event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY))
      this.store.panBy((sideways / (spot.width - GUTTER_WIDTH)) * (stop_s - start_s));
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
    const person = findLane(this.lanes(), spot.y)?.person ?? null;
    if (person !== null) this.store.show(person);
    if (person !== null && segment) this.store.select(segment);
    else if (person !== null && spot.x < GUTTER_WIDTH)
      return; // a click on the name only activates the person
    else if (segment && findLane(this.lanes(), spot.y)?.level) this.store.select(segment);
    else this.store.seek(segment?.start_s ?? this.getSecondsAt(spot));
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
    const { start_s, stop_s } = this.store.range.value;
    const reach = (spot.reach / (spot.width - GUTTER_WIDTH)) * (stop_s - start_s);
    const frame = findBorder(lane.segments, this.getSecondsAt(spot), reach, this.store.fps.value);
    return frame === null ? null : { lane, drag: { lane: lane.id, frame, to: frame } };
  }

  private getSecondsAt({ x, width }: Spot): number {
    return toSeconds(this.store.range.value, width - GUTTER_WIDTH, x - GUTTER_WIDTH);
  }
}

function getSpot(event: PointerEvent | WheelEvent): Spot {
  const { width } = (event.currentTarget as Element).getBoundingClientRect();
  const reach = "pointerType" in event && event.pointerType === "touch" ? TOUCH_REACH : MOUSE_REACH;
  return { ...getPosition(event), width, reach };
}
