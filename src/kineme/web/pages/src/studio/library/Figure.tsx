/** Draw a small strip of poses or an animation of a span once it is visible. */
import { useSignal, useSignalEffect } from "@preact/signals";
import { useCallback, useEffect, useRef } from "preact/hooks";
import { getClusterColor, adaptColor } from "../../colors";
import type { Span } from "../../messages";
import { unpackMotion } from "../../motion";
import { decodeBase64 } from "../../recordingData";
import { theme } from "../../theme";
import { drawCurves, drawPoses, prepareCanvas, type Sketch, flattenMotion } from "./drawing";
import { type Api, explainError } from "../server/api";

const POSES = [0, 1 / 6, 2 / 6, 3 / 6, 4 / 6, 5 / 6, 1];
const MAX_SKETCHES = 600;

/** Load and cache the sketches of a page. */
export class Sketches {
  private readonly cache = new Map<string, Promise<Sketch>>();

  constructor(private readonly api: Api) {}

  load(span: Span): Promise<Sketch> {
    const key = JSON.stringify([span.recording, span.start_s, span.stop_s]);
    const kept = this.cache.get(key) ?? this.request(span);
    this.cache.delete(key);
    this.cache.set(key, kept); // move to the end: the first ones are dropped first
    kept.catch(() => this.cache.delete(key));
    for (const old of this.cache.keys()) {
      if (this.cache.size <= MAX_SKETCHES) break;
      this.cache.delete(old);
    }
    return kept;
  }

  private async request(span: Span): Promise<Sketch> {
    const { motion, numbers, curves } = await this.api.loadFigure(span);
    if (!motion) return { flat: null, curves };
    const packed = decodeBase64(numbers).buffer;
    return { flat: flattenMotion(await unpackMotion(motion, packed)), curves };
  }
}

interface Props {
  sketches: Sketches;
  span: Span;
  cluster: number;
  /** Whether to animate; undefined draws a strip of poses. */
  playing?: boolean | undefined;
}

export function Figure({ sketches, span, cluster, playing }: Props) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const sketch = useSignal<Sketch | null>(null);
  const failure = useSignal("");
  const visible = useRef(false);
  const { recording, start_s, stop_s } = span;

  const draw = useCallback(
    (share: number): void => {
      const shown = sketch.peek();
      const pen = canvas.current && shown && prepareCanvas(canvas.current);
      if (!pen) return;
      const color = adaptColor(getClusterColor(cluster), theme.peek());
      if (shown.flat) drawPoses(pen, shown.flat, playing === undefined ? POSES : [share], color);
      else drawCurves(pen, shown.curves, playing ? share : null, color);
    },
    [sketch, cluster, playing],
  );

  useEffect(() => {
    sketch.value = null;
    failure.value = "";
    let here = true;
    const inView = new IntersectionObserver((entries) => {
      visible.current = entries.at(-1)!.isIntersecting;
      if (!visible.current || sketch.peek()) return;
      sketches
        .load({ recording, start_s, stop_s })
        .then((found) => here && (sketch.value = found))
        .catch((error: unknown) => here && (failure.value = explainError(error)));
    });
    inView.observe(canvas.current!);
    return () => {
      here = false;
      inView.disconnect();
    };
  }, [sketches, recording, start_s, stop_s, sketch, failure]);

  useEffect(() => {
    const sized = new ResizeObserver(() => draw(0.5));
    sized.observe(canvas.current!);
    return () => sized.disconnect();
  }, [draw]);

  useSignalEffect(() => {
    if (sketch.value && theme.value) draw(0.5);
  });

  useEffect(() => {
    if (!playing) {
      draw(0.5);
      return;
    }
    let picture = 0;
    const next = (now: number): void => {
      const { flat } = sketch.peek() ?? {};
      const shown_s = flat ? flat.poses.length / flat.fps : stop_s - start_s;
      const lasts = 1000 * Math.max(shown_s, 0.1);
      if (visible.current) draw((now % lasts) / lasts);
      picture = requestAnimationFrame(next);
    };
    picture = requestAnimationFrame(next);
    return () => cancelAnimationFrame(picture);
  }, [playing, draw, sketch, start_s, stop_s]);

  return (
    <span class="figure" data-drawn={sketch.value !== null}>
      <canvas ref={canvas} aria-hidden="true" />
      {failure.value && (
        <span class="quiet" title={failure.value}>
          cannot be drawn
        </span>
      )}
    </span>
  );
}
