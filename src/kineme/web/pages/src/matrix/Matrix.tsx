/** Show the self-similarity matrix; similar frames are bright. */
import { useMemo } from "preact/hooks";
import type { JSX } from "preact";
import { useStore } from "../context";
import { Canvas } from "../canvas/Canvas";
import { PlayheadLine } from "../canvas/PlayheadLine";
import { theme } from "../theme";
import { formatTime, toPixel, type Span } from "../view";
import { drawMatrix, EDGE } from "./drawing";
import { MatrixGestures } from "./gestures";
import { MatrixTiles } from "./tiles";

export function Matrix(): JSX.Element {
  const store = useStore();
  const data = store.active.value?.data;
  const tiles = useMemo(() => (data ? new MatrixTiles(data) : null), [data]);
  const gestures = useMemo(() => new MatrixGestures(store), [store]);
  const { pointer, rows } = gestures;
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
              tiles.loadCount.value,
            ];
          }}
          draw={(pen, width) => {
            // While the recording changes, its head and the tiles may belong to different
            // recordings.
            const { active } = store;
            tiles.applyTheme(theme.value);
            const head = active.value?.data === data ? store.recording.value?.matrix : undefined;
            const frame = { side: width - EDGE, down: rows.value, across: store.range.value };
            if (head && head.sizes.length) drawMatrix(pen, head, tiles, frame, store);
          }}
          gestures={gestures}
        />
        <Crosshair rows={rows} />
      </div>
      <p class="matrix-note quiet number">
        {pointer.value
          ? `${formatTime(Math.max(pointer.value.x, 0), 1)} and ${formatTime(Math.max(pointer.value.y, 0), 1)}`
          : "How similar any two frames are"}
      </p>
    </div>
  );
}

/** Show the playhead on both axes. */
function Crosshair({ rows }: { rows: { value: Span } }): JSX.Element {
  const store = useStore();
  const { playhead, range } = store;
  return (
    <div class="cross">
      <PlayheadLine share={toPixel(range.value, 1, playhead.value)} />
      <PlayheadLine share={toPixel(rows.value, 1, playhead.value)} horizontal />
    </div>
  );
}
