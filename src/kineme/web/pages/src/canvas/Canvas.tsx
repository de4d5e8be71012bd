/** Draw a canvas that fills its container, in device pixels, whenever its signals change. */
import { useEffect, useRef } from "preact/hooks";
import type { HTMLAttributes, JSX } from "preact";
import { signal } from "@preact/signals";
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

export interface PointerHandlers {
  down(event: PointerEvent): void;
  move(event: PointerEvent): void;
  up(event: PointerEvent): void;
  cancel(): void;
  leave(): void;
  wheel(event: WheelEvent): void;
}

export function Canvas({ label, watch, draw, gestures, ...rest }: Props): JSX.Element {
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
