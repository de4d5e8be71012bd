/** The self-similarity matrix: similar frames are bright; click to go there. */
import { useMemo } from "preact/hooks";
import type { JSX } from "preact";
import { useStore } from "../context";
import { Canvas } from "../canvas/Canvas";
import { Line } from "../canvas/Line";
import { theme } from "../theme";
import { clock, toPixel, type Span } from "../view";
import { drawMatrix, EDGE } from "./drawing";
import { MatrixGestures } from "./gestures";
import { Tiles } from "./tiles";

export function Matrix(): JSX.Element {
  const store = useStore();
  const data = store.active.value?.data;
  const tiles = useMemo(() => (data ? new Tiles(data) : null), [data]);
  const gestures = useMemo(() => new MatrixGestures(store), [store]);
  const { pointed, rows } = gestures;
  if (!tiles) return <div class="matrix" />;

  return (
    <div class="matrix">
      <div class="matrix-square">
        <Canvas
          label="Self-similarity: how similar any two frames are. Click to go there; use the wheel or two fingers to zoom, drag to pan."
          watch={() => {
            void [store.activities.value, store.primitives.value, store.selected.value];
            void [
              store.labelColors.value,
              rows.value,
              store.range.value,
              store.hovered.value,
              tiles.arrived.value,
            ];
          }}
          draw={(pen, width) => {
            // Those of one recording and the tiles of another do not go together.
            const { active } = store;
            tiles.colorFor(theme.value);
            const head = active.value?.data === data ? store.recording.value?.matrix : undefined;
            const frame = { side: width - EDGE, down: rows.value, across: store.range.value };
            if (head && head.sizes.length) drawMatrix(pen, head, tiles, frame, store);
          }}
          gestures={gestures}
        />
        <Cross rows={rows} />
      </div>
      <p class="matrix-note quiet number">
        {pointed.value
          ? `${clock(Math.max(pointed.value.x, 0), 1)} and ${clock(Math.max(pointed.value.y, 0), 1)}`
          : "How similar any two frames are"}
      </p>
    </div>
  );
}

/** The playhead on both axes. */
function Cross({ rows }: { rows: { value: Span } }): JSX.Element {
  const store = useStore();
  const { playhead, range } = store;
  return (
    <div class="cross">
      <Line share={toPixel(range.value, 1, playhead.value)} />
      <Line share={toPixel(rows.value, 1, playhead.value)} lying />
    </div>
  );
}
