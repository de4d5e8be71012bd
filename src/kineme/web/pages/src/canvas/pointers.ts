/** Where pointers are on a canvas, and how they zoom: the wheel, and two fingers. */

/** Pixels a click may wander before it is a drag. */
export const CLICK = 4;

export interface Point {
  x: number;
  y: number;
}

/** What two fingers did: what was midway between them comes to a place, and fills more or less. */
export interface Pinch {
  from: Point;
  to: Point;
  /** Below 1 when the fingers part, to show less. */
  factor: number;
}

/** Pixels from the left and the top of what the event is for. */
export function placeOf(event: MouseEvent): Point {
  const { left, top } = (event.currentTarget as Element).getBoundingClientRect();
  return { x: event.clientX - left, y: event.clientY - top };
}

/** How much more is to be seen after a turn of the wheel. */
export function wheelFactor(event: WheelEvent): number {
  return Math.exp(0.0015 * event.deltaY);
}

const CLOSE = 24; // pixels between two fingers, at the least

export class Fingers {
  private readonly down = new Map<number, Point>();

  get count(): number {
    return this.down.size;
  }

  press(finger: number, place: Point): void {
    this.down.set(finger, place);
  }

  /** What a move did, if the finger is one of two. */
  move(finger: number, place: Point): Pinch | null {
    if (!this.down.has(finger)) return null;
    const before = this.span();
    this.down.set(finger, place);
    const after = this.span();
    if (!before || !after) return null;
    return { from: before.middle, to: after.middle, factor: before.length / after.length };
  }

  lift(finger: number): void {
    this.down.delete(finger);
  }

  clear(): void {
    this.down.clear();
  }

  private span(): { middle: Point; length: number } | null {
    const [a, b] = this.down.values();
    if (!a || !b) return null;
    const middle = { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 };
    return { middle, length: Math.max(Math.hypot(a.x - b.x, a.y - b.y), CLOSE) };
  }
}
