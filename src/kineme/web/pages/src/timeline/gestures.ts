/**
 * What pointers do on the lanes: scrub, select, pan, drag a border; two fingers zoom. A press that
 * hardly moves selects, also beside a border; one that moves takes the border along, by as much.
 */
import { CLICK, Fingers, placeOf, wheelFactor, type Pinch } from "../canvas/pointers";
import { indexAt } from "../segments";
import type { Drag } from "../state";
import type { Store } from "../store";
import { toSeconds } from "../view";

import { borderNear, GUTTER, laneAt, roomFor, RULER, type Lane } from "./lanes";

const GRIP = 5; // pixels to either side of a border
const FINGER = 12;
const LEAST_WIDTH = 6; // pixels of a segment that a dragged border leaves of it

/** A place on the canvas, and how far a border may be from it. */
interface Spot {
  x: number;
  y: number;
  width: number;
  grip: number;
}

/** A border that a press is near enough to take. */
interface Grip {
  lane: Lane;
  drag: Drag;
}

type Doing =
  | { what: "scrub" }
  | { what: "press"; spot: Spot; border: Grip | null }
  | { what: "pan"; last: number }
  | { what: "pinch" }
  | ({ what: "border"; x: number } & Grip);

export class Gestures {
  private doing: Doing | null = null;
  private readonly fingers = new Fingers();

  constructor(
    private readonly store: Store,
    private readonly lanes: () => readonly Lane[],
    private readonly onDrag: (drag: Drag | null) => void,
  ) {}

  down(event: PointerEvent): void {
    if (event.button !== 0) return;
    const spot = spotOf(event);
    (event.currentTarget as Element).setPointerCapture(event.pointerId);
    this.fingers.press(event.pointerId, spot);
    if (this.fingers.count > 1) {
      this.onDrag(null);
      this.doing = { what: "pinch" };
      return;
    }
    if (spot.y < RULER) {
      this.doing = { what: "scrub" };
      this.store.seek(this.secondsAt(spot));
    } else this.doing = { what: "press", spot, border: this.borderAt(spot) };
  }

  move(event: PointerEvent): void {
    const spot = spotOf(event);
    const pinch = this.fingers.move(event.pointerId, spot);
    if (pinch) this.pinched(pinch, spot);
    if (this.doing?.what === "press" && Math.abs(spot.x - this.doing.spot.x) > CLICK) {
      const { border } = this.doing;
      const { x } = this.doing.spot;
      this.doing = border ? { what: "border", x, ...border } : { what: "pan", last: x };
    }
    const { doing } = this;
    if (doing?.what === "scrub") this.store.seek(this.secondsAt(spot));
    else if (doing?.what === "pan") {
      this.store.panBy(this.secondsAt({ ...spot, x: doing.last }) - this.secondsAt(spot));
      doing.last = spot.x;
    } else if (doing?.what === "border") {
      const { start_s, stop_s } = this.store.range.value;
      const perPixel = ((stop_s - start_s) / (spot.width - GUTTER)) * this.store.fps.value;
      const least = Math.max(Math.ceil(perPixel * LEAST_WIDTH), 1);
      const { frame } = doing.drag;
      const [low, high] = roomFor(doing.lane.segments, frame, least);
      const to = Math.round(frame + perPixel * (spot.x - doing.x));
      doing.drag = { ...doing.drag, to: Math.min(Math.max(to, low), high) };
      this.onDrag(doing.drag);
      this.store.seek(doing.drag.to / this.store.fps.value);
    } else if (!doing) this.hover(event, spot);
  }

  up(event: PointerEvent): void {
    const { doing } = this;
    this.fingers.lift(event.pointerId);
    if (doing?.what === "pinch" && this.fingers.count) return;
    this.doing = null;
    if (doing?.what === "press") this.click(doing.spot);
    if (doing?.what !== "border") return;
    const { frame, to } = doing.drag;
    const { level } = doing.lane;
    if (level && to !== frame) this.store.edit.value?.({ kind: "move_border", level, frame, to });
    else this.onDrag(null);
  }

  /** Escape: a border goes back to where it was; whether there was anything to give up. */
  giveUp(): boolean {
    const { doing } = this;
    if (doing?.what !== "border") return false;
    this.cancel();
    this.store.seek(doing.drag.frame / this.store.fps.value);
    return true;
  }

  cancel(): void {
    this.fingers.clear();
    this.doing = null;
    this.onDrag(null);
  }

  leave(): void {
    this.store.hovered.value = null;
  }

  wheel(event: WheelEvent): void {
    const spot = spotOf(event);
    const { start_s, stop_s } = this.store.range.value;
    const sideways = event.shiftKey ? event.deltaY : event.deltaX;
    if (event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY))
      this.store.panBy((sideways / (spot.width - GUTTER)) * (stop_s - start_s));
    else this.store.zoomBy(wheelFactor(event), this.secondsAt(spot));
  }

  /** What lies between two fingers stays there. */
  private pinched(pinch: Pinch, spot: Spot): void {
    const at = this.secondsAt({ ...spot, ...pinch.from });
    this.store.zoomBy(pinch.factor, at);
    this.store.panBy(at - this.secondsAt({ ...spot, ...pinch.to }));
  }

  private click(spot: Spot): void {
    const segment = this.segmentAt(spot);
    const person = laneAt(this.lanes(), spot.y)?.person ?? null;
    if (person !== null) this.store.show(person);
    if (person !== null && segment) this.store.select(segment);
    else if (person !== null && spot.x < GUTTER)
      return; // their name alone
    else if (segment && laneAt(this.lanes(), spot.y)?.level) this.store.select(segment);
    else this.store.seek(segment?.start_s ?? this.secondsAt(spot));
  }

  private hover(event: PointerEvent, spot: Spot): void {
    const segment = this.segmentAt(spot);
    const isInFront = (laneAt(this.lanes(), spot.y)?.person ?? null) === null;
    this.store.hovered.value =
      segment && isInFront && segment.cluster >= 0 ? segment.cluster : null;
    const cursor = spot.y < RULER || this.borderAt(spot) ? "ew-resize" : segment ? "pointer" : "";
    (event.currentTarget as HTMLElement).style.cursor = cursor;
  }

  private segmentAt(spot: Spot): Lane["segments"][number] | undefined {
    const lane = laneAt(this.lanes(), spot.y);
    if (!lane || spot.x < GUTTER) return undefined;
    const seconds = this.secondsAt(spot);
    const segment = lane.segments[indexAt(lane.segments, this.store.frameAt(seconds))];
    return segment && seconds < segment.stop_s && seconds >= segment.start_s ? segment : undefined;
  }

  private borderAt(spot: Spot): Grip | null {
    const lane = laneAt(this.lanes(), spot.y);
    if (!this.store.edit.value || !lane?.level || spot.x < GUTTER) return null;
    const { start_s, stop_s } = this.store.range.value;
    const reach = (spot.grip / (spot.width - GUTTER)) * (stop_s - start_s);
    const frame = borderNear(lane.segments, this.secondsAt(spot), reach, this.store.fps.value);
    return frame === null ? null : { lane, drag: { lane: lane.id, frame, to: frame } };
  }

  private secondsAt({ x, width }: Spot): number {
    return toSeconds(this.store.range.value, width - GUTTER, x - GUTTER);
  }
}

function spotOf(event: PointerEvent | WheelEvent): Spot {
  const { width } = (event.currentTarget as Element).getBoundingClientRect();
  const grip = "pointerType" in event && event.pointerType === "touch" ? FINGER : GRIP;
  return { ...placeOf(event), width, grip };
}
