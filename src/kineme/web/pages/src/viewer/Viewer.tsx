/** Show the figures in 3-D. */
import { useEffect, useRef } from "preact/hooks";
import type { JSX } from "preact";
import { useStore } from "../context";
import { Caption } from "./Caption";
import { startUpdates, turnByKey } from "./updates";
import { FigureScene } from "./scene";
import { ViewerButtons } from "./ViewerButtons";

export function Viewer(): JSX.Element {
  const store = useStore();
  const canvas = useRef<HTMLCanvasElement>(null);
  const scene = useRef<FigureScene | null>(null);
  useEffect(() => {
    const element = canvas.current!;
    const made = new FigureScene(store, element);
    scene.current = made;
    const stop = startUpdates(store, made, element);
    return () => {
      stop();
      made.dispose();
    };
  }, [store]);
  return (
    <div class="viewer" inert={!store.active.value}>
      <canvas
        ref={canvas}
        tabIndex={0}
        role="img"
        aria-label="Figure in 3-D. Drag or press alt and an arrow key to look from another side."
        onKeyDown={(event) => turnByKey(event, scene.current)}
      />
      <Caption />
      <ViewerButtons onFrame={() => scene.current?.frameFigures()} />
    </div>
  );
}
