/** Draw a canvas that fills its container, in device pixels, whenever its signals change. */
import { useEffect, useRef, useMemo } from "preact/hooks";
import type { HTMLAttributes } from "preact";
import { signal, effect, type ReadonlySignal } from "@preact/signals";
import { theme } from "../theme";
import { drawOnChange } from "../ticker";

export type Draw = (pen: CanvasRenderingContext2D, width: number, height: number) => void;

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
  const latest = useRef({ watch, draw, gestures });
  latest.current = { watch, draw, gestures };
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
    const onWheel = (event: WheelEvent): void => {
      if (!latest.current.gestures) return;
      event.preventDefault();
      latest.current.gestures.wheel(event);
    };
    canvas.addEventListener("wheel", onWheel, { passive: false });
    return () => {
      stop();
      resizeObserver.disconnect();
      canvas.removeEventListener("wheel", onWheel);
    };
  }, []);
  const pointers = gestures && {
    onPointerDown: (event: PointerEvent) => gestures.down(event),
    onPointerMove: (event: PointerEvent) => gestures.move(event),
    onPointerUp: (event: PointerEvent) => gestures.up(event),
    onPointerCancel: () => gestures.cancel(),
    onPointerLeave: () => gestures.leave(),
  };
  return <canvas ref={ref} role="img" aria-label={label} {...pointers} {...rest} />;
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
