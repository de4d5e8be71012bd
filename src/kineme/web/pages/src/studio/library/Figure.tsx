/** A small figure of a span: read when it comes into view, a strip, or one that plays. */
import { useSignal, useSignalEffect } from "@preact/signals";
import type { JSX } from "preact";
import { useCallback, useEffect, useRef } from "preact/hooks";
import { clusterColor, onPage } from "../../colors";
import type { Span } from "../../messages";
import { unpackMotion } from "../../motion";
import { theme } from "../../theme";
import { drawCurves, drawPoses, sheet, type Sketch } from "./drawing";
import { flattened } from "./flat";
import { explain } from "../server/answers";
import type { LibraryApi } from "./libraryApi";

const POSES = [0, 1 / 6, 2 / 6, 3 / 6, 4 / 6, 5 / 6, 1];
const MOST_KEPT = 600;

/** The sketches of a page, each asked for once. */
export class Sketches {
  private readonly kept = new Map<string, Promise<Sketch>>();

  constructor(private readonly api: LibraryApi) {}

  of(span: Span): Promise<Sketch> {
    const key = JSON.stringify([span.recording, span.start_s, span.stop_s]);
    const kept = this.kept.get(key) ?? this.ask(span);
    this.kept.delete(key);
    this.kept.set(key, kept); // the last one is the newest
    kept.catch(() => this.kept.delete(key));
    for (const old of this.kept.keys()) {
      if (this.kept.size <= MOST_KEPT) break;
      this.kept.delete(old);
    }
    return kept;
  }

  private async ask(span: Span): Promise<Sketch> {
    const { motion, numbers, curves } = await this.api.figure(span);
    if (!motion) return { flat: null, curves };
    const packed = Uint8Array.from(atob(numbers), (letter) => letter.charCodeAt(0));
    return { flat: flattened(await unpackMotion(motion, packed.buffer)), curves };
  }
}

interface Props {
  sketches: Sketches;
  span: Span;
  cluster: number;
  /** Whether it moves; a strip where it never does. */
  playing?: boolean | undefined;
}

export function Figure({ sketches, span, cluster, playing }: Props): JSX.Element {
  const canvas = useRef<HTMLCanvasElement>(null);
  const sketch = useSignal<Sketch | null>(null);
  const failure = useSignal("");
  const visible = useRef(false);
  const { recording, start_s, stop_s } = span;

  const draw = useCallback(
    (share: number): void => {
      const shown = sketch.peek();
      const pen = canvas.current && shown && sheet(canvas.current);
      if (!pen) return;
      const color = onPage(clusterColor(cluster), theme.peek());
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
        .of({ recording, start_s, stop_s })
        .then((found) => here && (sketch.value = found))
        .catch((error: unknown) => here && (failure.value = explain(error)));
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
