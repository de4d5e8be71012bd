/** Locate pointers on a canvas and zoom with the wheel or two fingers. */

/** Pixels a pointer may move before a click becomes a drag. */
export const CLICK_TOLERANCE = 4;

export interface Point {
  x: number;
  y: number;
}

/** The midpoint of two fingers moved from one point to another while their distance changed. */
export interface Pinch {
  from: Point;
  to: Point;
  /** Below 1 when the fingers move apart, to zoom in. */
  factor: number;
}

/** Return the pointer's position in pixels from the element's left and top edges. */
export function getPosition(event: MouseEvent): Point {
  const { left, top } = (event.currentTarget as Element).getBoundingClientRect();
  return { x: event.clientX - left, y: event.clientY - top };
}

/** Return the factor by which the visible range grows after a wheel turn. */
export function getZoomFactor(event: WheelEvent): number {
  return Math.exp(0.0015 * event.deltaY);
}

const MIN_DISTANCE = 24; // pixels between two fingers; smaller distances would make the factor jump

export class TouchTracker {
  private readonly down = new Map<number, Point>();

  get count(): number {
    return this.down.size;
  }

  press(finger: number, place: Point): void {
    this.down.set(finger, place);
  }

  /** Move a finger and return the pinch, or null unless two fingers touch. */
  move(finger: number, place: Point): Pinch | null {
    if (!this.down.has(finger)) return null;
    const before = this.measureSpan();
    this.down.set(finger, place);
    const after = this.measureSpan();
    if (!before || !after) return null;
    return { from: before.middle, to: after.middle, factor: before.length / after.length };
  }

  lift(finger: number): void {
    this.down.delete(finger);
  }

  clear(): void {
    this.down.clear();
  }

  private measureSpan(): { middle: Point; length: number } | null {
    const [a, b] = this.down.values();
    if (!a || !b) return null;
    const middle = { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 };
    return { middle, length: Math.max(Math.hypot(a.x - b.x, a.y - b.y), MIN_DISTANCE) };
  }
}
