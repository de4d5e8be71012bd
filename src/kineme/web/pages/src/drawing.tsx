/** Draw: colours of the theme, one drawing loop, canvases that redraw themselves, and pointers on them. */
import { computed, effect, signal, type ReadonlySignal } from "@preact/signals";
import { useEffect, useMemo, useRef } from "preact/hooks";
import type { HTMLAttributes } from "preact";
import { listen } from "./util";

export type Theme = "dark" | "light";

const media = matchMedia("(prefers-color-scheme: dark)");
const system = signal<Theme>(media.matches ? "dark" : "light");
const chosen = signal<Theme | null>(null);
/** Whether the page is being printed. */
export const isPrinting = signal(false);

media.addEventListener("change", () => (system.value = media.matches ? "dark" : "light"));

export const theme = computed<Theme>(() =>
  isPrinting.value ? "light" : (chosen.value ?? system.value),
);

// Canvases read the CSS variables right after this, so it must not wait for a frame.
effect(() => document.documentElement.setAttribute("data-theme", theme.value));

export function toggleTheme(): void {
  chosen.value = theme.value === "dark" ? "light" : "dark";
}

/** Return a colour of the theme's style sheet as `#rrggbb` or `rgba(…)`. */
export function readColor(name: string): string {
  const key = `${theme.value} ${name}`; // makes callers depend on the theme
  let color = colors.get(key);
  if (color === undefined) {
    const root = document.documentElement;
    root.style.outlineColor = `var(--${name})`; // resolves the variable; nothing is outlined
    colorPen ??= new OffscreenCanvas(1, 1).getContext("2d")!;
    colorPen.fillStyle = getComputedStyle(root).outlineColor;
    color = String(colorPen.fillStyle); // normalised by the canvas
    colors.set(key, color);
  }
  return color;
}

const colors = new Map<string, string>();
let colorPen: OffscreenCanvasRenderingContext2D | null = null;

/** Called before each frame with the seconds since the last one (at most 0.5). */
type Task = (seconds: number) => void;

class Ticker {
  /** Number of frames drawn. */
  drawn = 0;
  private readonly tasks = new Set<Task>();
  private readonly times: number[] = [];
  private pending = 0;
  private last = 0;

  add(task: Task): () => void {
    this.tasks.add(task);
    this.request();
    return () => this.tasks.delete(task);
  }

  /** Request another frame. */
  request(): void {
    if (this.pending === 0) this.pending = requestAnimationFrame((now) => this.run(now));
  }

  /** Draw immediately. */
  drawNow(): void {
    cancelAnimationFrame(this.pending);
    this.run(performance.now());
  }

  /** Return the number of frames within the last second. */
  measureRate(now: number = performance.now()): number {
    return this.times.filter((time) => now - time <= 1000).length;
  }

  private run(now: number): void {
    this.pending = 0;
    const seconds = Math.min(Math.max((now - this.last) / 1000, 0), 0.5);
    this.last = now;
    this.times.push(now);
    if (this.times.length > 240) this.times.splice(0, 120);
    this.drawn += 1;
    for (const task of this.tasks) task(seconds);
  }
}

export const ticker = new Ticker();

/** Draw when a signal read by `watch` changes; return a function that stops. */
export function drawOnChange(watch: () => void, draw: Task): () => void {
  let dirty = true;
  const stopDrawing = ticker.add((seconds) => {
    if (!dirty) return;
    dirty = false;
    draw(seconds);
  });
  const stopWatching = effect(() => {
    watch();
    dirty = true;
    ticker.request();
  });
  return () => {
    stopWatching();
    stopDrawing();
  };
}

type Draw = (pen: Pen, width: number, height: number) => void;

interface Props extends Omit<HTMLAttributes<HTMLCanvasElement>, "label"> {
  label: string;
  /** Read the signals that the picture depends on. */
  watch: () => void;
  /** Redraw everything; sizes are in CSS pixels. */
  draw: Draw;
  /** Handle pointers and the wheel in place of the browser's scrolling and zooming. */
  gestures?: PointerHandlers;
}

interface PointerHandlers {
  down(event: PointerEvent): void;
  move(event: PointerEvent): void;
  up(event: PointerEvent): void;
  cancel(): void;
  leave(): void;
  wheel(event: WheelEvent): void;
}

export function Canvas({ label, watch, draw, gestures, ...rest }: Props) {
  const ref = useRef<HTMLCanvasElement>(null);
  const latest = useRef({ watch, draw });
  latest.current = { watch, draw };
  useEffect(() => {
    const canvas = ref.current!;
    const size = signal({ width: 0, height: 0 });
    const resizeObserver = new ResizeObserver(() => {
      size.value = { width: canvas.clientWidth, height: canvas.clientHeight };
    });
    resizeObserver.observe(canvas);
    const stop = drawOnChange(
      () => {
        void [theme.value, size.value];
        latest.current.watch();
      },
      () => paintCanvas(canvas, size.value, latest.current.draw),
    );
    return () => {
      stop();
      resizeObserver.disconnect();
    };
  }, []);
  useEffect(() => {
    if (!gestures) return;
    const listeners = {
      pointerdown: (event: PointerEvent) => gestures.down(event),
      pointermove: (event: PointerEvent) => gestures.move(event),
      pointerup: (event: PointerEvent) => gestures.up(event),
      pointercancel: () => gestures.cancel(),
      pointerleave: () => gestures.leave(),
      wheel(event: WheelEvent) {
        event.preventDefault();
        gestures.wheel(event);
      },
    };
    return listen(ref.current!, listeners, { passive: false });
  }, [gestures]);
  return <canvas ref={ref} role="img" aria-label={label} {...rest} />;
}

function paintCanvas(
  canvas: HTMLCanvasElement,
  { width, height }: { width: number; height: number },
  draw: Draw,
): void {
  if (width === 0 || height === 0) return;
  const ratio = devicePixelRatio;
  const [w, h] = [Math.round(width * ratio), Math.round(height * ratio)];
  if (canvas.width !== w || canvas.height !== h) [canvas.width, canvas.height] = [w, h];
  // Without a graphics card, a canvas in main memory is several times faster.
  const pen = canvas.getContext("2d", { willReadFrequently: true })!;
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, width, height);
  draw(pen, width, height);
}

interface PlayheadLineProps {
  /** Position from 0 (start of the container) to 1 (end); hidden outside this range. */
  share: number;
  /** Whether the line is horizontal and moves down. */
  horizontal?: boolean;
  handle?: boolean;
}

/** Draw the playhead as a line across its container; moving it redraws no canvas. */
export function PlayheadLine({ share, horizontal = false, handle = false }: PlayheadLineProps) {
  if (!(share >= 0 && share <= 1)) return null;
  const move = horizontal ? `translateY(${100 * share}cqh)` : `translateX(${100 * share}cqw)`;
  const kind = `${horizontal ? "horizontal" : "vertical"}${handle ? " handle" : ""}`;
  return <div class={`line ${kind}`} style={{ transform: move }} />;
}

const INTERVAL = 100; // milliseconds

/** Return a copy of a signal that changes at most ten times a second during playback. */
export function useThrottled<T>(
  fast: ReadonlySignal<T>,
  playing: ReadonlySignal<boolean>,
): ReadonlySignal<T> {
  const calm = useMemo(() => signal(fast.peek()), [fast]);
  useEffect(() => {
    let last = -Infinity;
    return effect(() => {
      const value = fast.value;
      const now = performance.now();
      if (playing.value && now - last < INTERVAL) return;
      last = now;
      calm.value = value;
    });
  }, [fast, playing, calm]);
  return calm;
}

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

/** Places of the fingers that touch, by pointer. */
export type Touches = Map<number, Point>;

/** Move a finger and return the pinch, or null unless two fingers touch. */
export function moveFinger(touches: Touches, finger: number, place: Point): Pinch | null {
  if (!touches.has(finger)) return null;
  const before = measureSpan(touches);
  touches.set(finger, place);
  const after = measureSpan(touches);
  if (!before || !after) return null;
  return { from: before.middle, to: after.middle, factor: before.length / after.length };
}

function measureSpan(touches: Touches): { middle: Point; length: number } | null {
  const [a, b] = touches.values();
  if (!a || !b) return null;
  const middle = { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 };
  return { middle, length: Math.max(Math.hypot(a.x - b.x, a.y - b.y), MIN_DISTANCE) };
}

export type Pen = CanvasRenderingContext2D;

export const FONT = "11px system-ui, sans-serif";

/** Return as much of a text as fits, with an ellipsis; empty if too little fits. */
export function shortenText(pen: Pen, text: string, space: number): string {
  if (pen.measureText(text).width <= space) return text;
  for (let n = text.length - 1; n >= 3; n--) {
    const part = text.slice(0, n) + "…";
    if (pen.measureText(part).width <= space) return part;
  }
  return "";
}

/** Return grey stripes, which mark segments without cluster. */
export function createHatch(pen: Pen): CanvasPattern | string {
  const tile = document.createElement("canvas");
  tile.width = tile.height = 6;
  const brush = tile.getContext("2d")!;
  brush.strokeStyle = readColor("hatch");
  brush.lineWidth = 1.2;
  for (const shift of [-6, 0, 6]) {
    brush.moveTo(shift, 6);
    brush.lineTo(shift + 6, 0);
  }
  brush.stroke();
  return pen.createPattern(tile, "repeat") ?? readColor("hatch");
}

/** Run `draw` with everything outside of a box clipped off. */
export function drawInside(
  pen: Pen,
  box: readonly [x: number, y: number, width: number, height: number],
  draw: () => void,
): void {
  pen.save();
  pen.beginPath();
  pen.rect(...box);
  pen.clip();
  draw();
  pen.restore();
}

/** Stroke a line through points; null interrupts it. */
export function strokeLine(pen: Pen, points: readonly (readonly [number, number] | null)[]): void {
  pen.beginPath();
  let isDown = false;
  for (const point of points) {
    if (point && isDown) pen.lineTo(...point);
    else if (point) pen.moveTo(...point);
    isDown = point !== null;
  }
  pen.stroke();
}
