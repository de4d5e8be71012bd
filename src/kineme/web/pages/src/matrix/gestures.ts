/** Handle pointers on the matrix: seek, pan and zoom. */
import { computed, signal, type ReadonlySignal } from "@preact/signals";
import {
  CLICK_TOLERANCE,
  TouchTracker,
  getPosition,
  getZoomFactor,
  type Point,
} from "../canvas/pointers";
import { findSegmentAt } from "../segments";
import type { Store } from "../store";
import { panRange, toSeconds, zoomRange, type Span } from "../view";
import { EDGE } from "./drawing";
import { chooseRows } from "./pyramid";

export class MatrixGestures {
  /** The two times at the pointer, in seconds; null outside. */
  readonly pointer = signal<Point | null>(null);
  /** Time span from top to bottom; the timeline's range is shown from left to right. */
  readonly rows: ReadonlySignal<Span>;
  private readonly movedRows = signal<Span | null>(null);
  private readonly touches = new TouchTracker();
  private pressed: { place: Point; last: Point; far: boolean } | null = null;

  constructor(private readonly store: Store) {
    this.rows = computed(() => chooseRows(this.movedRows.value, store.range.value));
  }

  down(event: PointerEvent): void {
    const place = getPosition(event);
    (event.currentTarget as Element).setPointerCapture(event.pointerId);
    this.touches.press(event.pointerId, place);
    this.pressed = this.touches.count > 1 ? null : { place, last: place, far: false };
  }

  move(event: PointerEvent): void {
    const place = getPosition(event);
    const side = getSide(event);
    this.pointer.value = this.getTimesAt(place, side);
    const pinch = this.touches.move(event.pointerId, place);
    if (pinch) {
      this.zoom(pinch.factor, this.getTimesAt(pinch.from, side));
      this.pan(pinch.from, pinch.to, side);
    }
    const { pressed } = this;
    if (!pressed) return;
    const from = pressed.place;
    pressed.far ||= Math.hypot(place.x - from.x, place.y - from.y) >= CLICK_TOLERANCE;
    if (!pressed.far) return;
    this.pan(pressed.last, place, side);
    pressed.last = place;
  }

  up(event: PointerEvent): void {
    const clicked = this.pressed && !this.pressed.far;
    this.pressed = null;
    this.touches.lift(event.pointerId);
    if (!clicked) return;
    const { x } = this.getTimesAt(getPosition(event), getSide(event));
    const segment = findSegmentAt(this.store.primitives.value, this.store.getFrameAt(x));
    if (segment) this.store.select(segment, { seek: false });
    this.store.seek(x);
  }

  cancel(): void {
    this.pressed = null;
    this.touches.clear();
  }

  leave(): void {
    this.pointer.value = null;
  }

  wheel(event: WheelEvent): void {
    this.zoom(getZoomFactor(event), this.getTimesAt(getPosition(event), getSide(event)));
  }

  private zoom(factor: number, at: Point): void {
    const next = zoomRange(this.rows.value, factor, at.y, this.store.duration.value);
    this.store.zoomBy(factor, at.x);
    this.movedRows.value = this.store.zoom.value ? next : null;
  }

  private pan(from: Point, to: Point, side: number): void {
    if (!this.store.zoom.value) return;
    const [before, after] = [this.getTimesAt(from, side), this.getTimesAt(to, side)];
    this.movedRows.value = panRange(this.rows.value, before.y - after.y, this.store.duration.value);
    this.store.panBy(before.x - after.x);
  }

  private getTimesAt({ x, y }: Point, side: number): Point {
    return {
      x: toSeconds(this.store.range.value, side, x - EDGE),
      y: toSeconds(this.rows.value, side, y - EDGE),
    };
  }
}

/** Return the side of the drawn square in pixels. */
function getSide(event: MouseEvent): number {
  return (event.currentTarget as Element).clientWidth - EDGE;
}
