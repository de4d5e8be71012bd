/** A canvas that fills its place, sharp on any screen, redrawn when what it shows has changed. */
import { useEffect, useRef } from "preact/hooks";
import type { HTMLAttributes, JSX } from "preact";
import { signal } from "@preact/signals";
import { theme } from "../theme";
import { painter } from "../ticker";

export type Draw = (pen: CanvasRenderingContext2D, width: number, height: number) => void;

interface Props extends Omit<HTMLAttributes<HTMLCanvasElement>, "label"> {
  label: string;
  /** Reads the signals that the picture depends on. */
  watch: () => void;
  /** Draws everything anew; sizes in CSS pixels. */
  draw: Draw;
  /** Called without the browser's own reaction, which would scroll or zoom the page. */
  onWheelZoom?: (event: WheelEvent) => void;
}

export function Canvas({ label, watch, draw, onWheelZoom, ...rest }: Props): JSX.Element {
  const ref = useRef<HTMLCanvasElement>(null);
  const latest = useRef({ watch, draw, onWheelZoom });
  latest.current = { watch, draw, onWheelZoom };
  useEffect(() => {
    const canvas = ref.current!;
    const size = signal({ width: 0, height: 0 });
    const onResize = new ResizeObserver(() => {
      size.value = { width: canvas.clientWidth, height: canvas.clientHeight };
    });
    onResize.observe(canvas);
    const stop = painter(
      () => {
        void [theme.value, size.value];
        latest.current.watch();
      },
      () => paint(canvas, size.value, latest.current.draw),
    );
    const onWheel = (event: WheelEvent): void => {
      if (!latest.current.onWheelZoom) return;
      event.preventDefault();
      latest.current.onWheelZoom(event);
    };
    canvas.addEventListener("wheel", onWheel, { passive: false });
    return () => {
      stop();
      onResize.disconnect();
      canvas.removeEventListener("wheel", onWheel);
    };
  }, []);
  return <canvas ref={ref} role="img" aria-label={label} {...rest} />;
}

function paint(
  canvas: HTMLCanvasElement,
  { width, height }: { width: number; height: number },
  draw: Draw,
): void {
  if (width === 0 || height === 0) return;
  const ratio = devicePixelRatio;
  const [w, h] = [Math.round(width * ratio), Math.round(height * ratio)];
  if (canvas.width !== w || canvas.height !== h) [canvas.width, canvas.height] = [w, h];
  // Kept in main memory: without a graphics card that is several times faster.
  const pen = canvas.getContext("2d", { willReadFrequently: true })!;
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, width, height);
  draw(pen, width, height);
}
