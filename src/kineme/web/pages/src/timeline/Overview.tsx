/** Show the whole recording and the visible range; drag to move the range or to seek. */
import { useRef } from "preact/hooks";
import type { JSX } from "preact";
import { useStore } from "../context";
import { Canvas } from "../canvas/Canvas";
import { readColor } from "../theme";
import type { Store } from "../store";
import { toPixel } from "../view";

export function Overview(): JSX.Element {
  const store = useStore();
  const dragging = useRef(false);
  const moveTo = (event: PointerEvent): void => {
    const { left, width } = (event.currentTarget as Element).getBoundingClientRect();
    const { start_s, stop_s } = store.range.value;
    const at = ((event.clientX - left) / width) * store.duration.value;
    if (store.zoom.value) store.panBy(at - (start_s + stop_s) / 2);
    else store.seek(at);
  };
  return (
    <div class="overview">
      <Canvas
        label="The whole recording; drag to choose what the lanes show."
        watch={() =>
          void [
            store.activities.value,
            store.labelColors.value,
            store.range.value,
            store.duration.value,
          ]
        }
        draw={(pen, width, height) => draw(pen, width, height, store)}
        onPointerDown={(event) => {
          event.currentTarget.setPointerCapture(event.pointerId);
          dragging.current = true;
          moveTo(event);
        }}
        onPointerMove={(event) => dragging.current && moveTo(event)}
        onPointerUp={() => (dragging.current = false)}
        onPointerCancel={() => (dragging.current = false)}
      />
    </div>
  );
}

function draw(pen: CanvasRenderingContext2D, width: number, height: number, store: Store): void {
  const recording = { start_s: 0, stop_s: store.duration.value };
  pen.fillStyle = readColor("lane");
  pen.fillRect(0, 0, width, height);
  for (const segment of store.activities.value) {
    const { start_s, stop_s } = segment;
    const color = store.getColor(segment);
    if (!color) continue;
    const left = toPixel(recording, width, start_s);
    pen.fillStyle = color;
    pen.fillRect(left, 2, Math.max(toPixel(recording, width, stop_s) - left, 0.5), height - 4);
  }
  const { start_s, stop_s } = store.range.value;
  const left = toPixel(recording, width, start_s);
  const right = toPixel(recording, width, stop_s);
  pen.globalAlpha = 0.6;
  pen.fillStyle = readColor("page");
  pen.fillRect(0, 0, left, height);
  pen.fillRect(right, 0, width - right, height);
  pen.globalAlpha = 1;
  pen.strokeStyle = readColor("quiet");
  pen.strokeRect(left + 0.5, 0.5, Math.max(right - left - 1, 2), height - 1);
}
