/** The self-similarity matrix: what looks alike is bright; click to go there. */
import { computed, useSignal } from "@preact/signals";
import { useEffect, useMemo, useRef } from "preact/hooks";
import type { JSX } from "preact";
import { Canvas } from "../canvas/Canvas";
import { Line } from "../canvas/Line";
import { segmentAt } from "../segments";
import type { Span, Store } from "../store";
import { theme } from "../theme";
import { clock, panned, toPixel, toSeconds, zoomed } from "../view";
import { drawMatrix, EDGE } from "./drawing";
import { rowsFor } from "./pyramid";
import { Tiles } from "./tiles";

const CLICK = 4; // pixels a click may wander before it is a drag

export function Matrix({ store }: { store: Store }): JSX.Element {
  const source = store.active.value?.source;
  const tiles = useMemo(() => (source ? new Tiles(source) : null), [source]);
  const moved = useSignal<Span | null>(null);
  const rows = useMemo(() => computed(() => rowsFor(moved.value, store.range.value)), [store]);
  const pointed = useSignal<{ x: number; y: number } | null>(null);
  const press = useRef<{ x: number; y: number; far: boolean } | null>(null);
  useEffect(() => tiles?.recolor(), [tiles, theme.value]);
  if (!tiles) return <div class="matrix" />;

  const total = (): number => store.duration.value;
  const spotOf = (event: MouseEvent): { x: number; y: number } => {
    const { left, top, width } = (event.currentTarget as Element).getBoundingClientRect();
    const side = width - EDGE;
    return {
      x: toSeconds(store.range.value, side, event.clientX - left - EDGE),
      y: toSeconds(rows.value, side, event.clientY - top - EDGE),
    };
  };
  const onMove = (event: PointerEvent): void => {
    const spot = spotOf(event);
    pointed.value = spot;
    if (!press.current) return;
    const { x, y, far } = press.current;
    const width = (event.currentTarget as Element).clientWidth - EDGE;
    const pixel = (store.range.value.stop_s - store.range.value.start_s) / width;
    if (!far && Math.hypot(spot.x - x, spot.y - y) < CLICK * pixel) return;
    press.current.far = true;
    if (!store.zoom.value) return;
    moved.value = panned(rows.value, y - spot.y, total());
    store.panBy(x - spot.x);
  };
  const onUp = (event: PointerEvent): void => {
    const clicked = press.current && !press.current.far;
    press.current = null;
    if (!clicked) return;
    const { x } = spotOf(event);
    const segment = segmentAt(store.primitives.value, store.frameAt(x));
    if (segment) store.select(segment, { seek: false });
    store.seek(x);
  };
  const onWheel = (event: WheelEvent): void => {
    const { x, y } = spotOf(event);
    const factor = Math.exp(0.0015 * event.deltaY);
    const next = zoomed(rows.value, factor, y, total());
    store.zoomBy(factor, x);
    moved.value = store.zoom.value ? next : null;
  };
  return (
    <div class="matrix">
      <div class="matrix-square">
        <Canvas
          label="Self-similarity: how alike each moment looks to each other. Click to go there; use the wheel to zoom, drag to pan."
          watch={() => {
            void [store.activities.value, store.primitives.value, store.selected.value];
            void [rows.value, store.range.value, store.hovered.value, tiles.arrived.value];
          }}
          draw={(pen, width) => {
            const head = store.recording.value?.matrix;
            const frame = { side: width - EDGE, down: rows.value, across: store.range.value };
            if (head && head.sizes.length) drawMatrix(pen, head, tiles, frame, store);
          }}
          onPointerDown={(event) => {
            event.currentTarget.setPointerCapture(event.pointerId);
            press.current = { ...spotOf(event), far: false };
          }}
          onPointerMove={onMove}
          onPointerUp={onUp}
          onPointerCancel={() => (press.current = null)}
          onPointerLeave={() => (pointed.value = null)}
          onWheelZoom={onWheel}
        />
        <Cross store={store} rows={rows} />
      </div>
      <p class="matrix-note quiet number">
        {pointed.value
          ? `${clock(Math.max(pointed.value.x, 0), 1)} and ${clock(Math.max(pointed.value.y, 0), 1)}`
          : "What looks alike, at any two moments"}
      </p>
    </div>
  );
}

/** The playhead on both axes. */
function Cross({ store, rows }: { store: Store; rows: { value: Span } }): JSX.Element {
  const { playhead, range } = store;
  return (
    <div class="cross">
      <Line share={toPixel(range.value, 1, playhead.value)} />
      <Line share={toPixel(rows.value, 1, playhead.value)} lying />
    </div>
  );
}
