/** What pointers do on the matrix: go to a time, pan, zoom; two fingers zoom, too. */
import { computed, signal, type ReadonlySignal } from "@preact/signals";
import { CLICK, Fingers, placeOf, wheelFactor, type Point } from "../canvas/pointers";
import { segmentAt } from "../segments";
import type { Store } from "../store";
import { panned, toSeconds, zoomed, type Span } from "../view";
import { EDGE } from "./drawing";
import { rowsFor } from "./pyramid";

export class MatrixGestures {
  /** The two times under the pointer, in seconds. */
  readonly pointed = signal<Point | null>(null);
  /** What is shown from top to bottom; from left to right it is what the timeline shows. */
  readonly rows: ReadonlySignal<Span>;
  private readonly moved = signal<Span | null>(null);
  private readonly fingers = new Fingers();
  private pressed: { place: Point; last: Point; far: boolean } | null = null;

  constructor(private readonly store: Store) {
    this.rows = computed(() => rowsFor(this.moved.value, store.range.value));
  }

  down(event: PointerEvent): void {
    const place = placeOf(event);
    (event.currentTarget as Element).setPointerCapture(event.pointerId);
    this.fingers.press(event.pointerId, place);
    this.pressed = this.fingers.count > 1 ? null : { place, last: place, far: false };
  }

  move(event: PointerEvent): void {
    const place = placeOf(event);
    const side = sideOf(event);
    this.pointed.value = this.timesAt(place, side);
    const pinch = this.fingers.move(event.pointerId, place);
    if (pinch) {
      this.zoom(pinch.factor, this.timesAt(pinch.from, side));
      this.pan(pinch.from, pinch.to, side);
    }
    const { pressed } = this;
    if (!pressed) return;
    const from = pressed.place;
    pressed.far ||= Math.hypot(place.x - from.x, place.y - from.y) >= CLICK;
    if (!pressed.far) return;
    this.pan(pressed.last, place, side);
    pressed.last = place;
  }

  up(event: PointerEvent): void {
    const clicked = this.pressed && !this.pressed.far;
    this.pressed = null;
    this.fingers.lift(event.pointerId);
    if (!clicked) return;
    const { x } = this.timesAt(placeOf(event), sideOf(event));
    const segment = segmentAt(this.store.primitives.value, this.store.frameAt(x));
    if (segment) this.store.select(segment, { seek: false });
    this.store.seek(x);
  }

  cancel(): void {
    this.pressed = null;
    this.fingers.clear();
  }

  leave(): void {
    this.pointed.value = null;
  }

  wheel(event: WheelEvent): void {
    this.zoom(wheelFactor(event), this.timesAt(placeOf(event), sideOf(event)));
  }

  private zoom(factor: number, at: Point): void {
    const next = zoomed(this.rows.value, factor, at.y, this.store.duration.value);
    this.store.zoomBy(factor, at.x);
    this.moved.value = this.store.zoom.value ? next : null;
  }

  private pan(from: Point, to: Point, side: number): void {
    if (!this.store.zoom.value) return;
    const [before, after] = [this.timesAt(from, side), this.timesAt(to, side)];
    this.moved.value = panned(this.rows.value, before.y - after.y, this.store.duration.value);
    this.store.panBy(before.x - after.x);
  }

  private timesAt({ x, y }: Point, side: number): Point {
    return {
      x: toSeconds(this.store.range.value, side, x - EDGE),
      y: toSeconds(this.rows.value, side, y - EDGE),
    };
  }
}

/** Pixels from edge to edge of what is drawn. */
function sideOf(event: MouseEvent): number {
  return (event.currentTarget as Element).clientWidth - EDGE;
}
