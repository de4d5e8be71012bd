/** Show the self-similarity matrix; similar frames are bright. */
import { useMemo } from "preact/hooks";
import { useStore } from "../store";
import { Canvas, PlayheadLine } from "../canvas/Canvas";
import { theme } from "../theme";
import { formatTime, toPixel, type Span } from "../view";
import { drawMatrix, EDGE } from "./drawing";
import { MatrixGestures } from "./gestures";
import { MatrixTiles } from "./tiles";
import { NO_COLOR } from "../colors";
import { getDuration, getSegmentName } from "../segments";
import { IconButton, Swatch } from "../layout/controls";
import { getConfidences } from "../confidence";

export function Matrix() {
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
function Crosshair({ rows }: { rows: { value: Span } }) {
  const store = useStore();
  const { playhead, range } = store;
  return (
    <div class="cross">
      <PlayheadLine share={toPixel(range.value, 1, playhead.value)} />
      <PlayheadLine share={toPixel(rows.value, 1, playhead.value)} horizontal />
    </div>
  );
}

/** Show the matrix and, if there is space, the current segment. */
export function MatrixPanel() {
  return (
    <div class="matrix-place">
      <div class="matrix-top">
        <Matrix />
      </div>
      <CurrentSegment />
    </div>
  );
}

/** Show the primitive at the playhead, with buttons to the other members of its cluster. */
export function CurrentSegment() {
  const store = useStore();
  const segment = store.present.value;
  if (!segment) return null;
  const table = store.recording.value?.segmentation;
  const confidence = table && getConfidences(table).get(segment);
  const cluster = store.clusters.value.find((each) => each.id === segment.cluster);
  const members = cluster?.members ?? [];
  const at = members.indexOf(segment);
  const selectMember = (by: number): void => {
    const next = members[(at + by + members.length) % members.length];
    if (next) store.select(next);
  };
  return (
    <section class="present" aria-label="At the playhead">
      <p class="present-name">
        <Swatch color={store.getColor(segment) ?? NO_COLOR} />
        <b>{getSegmentName(segment)}</b>
        <span class="spacer" />
        {at >= 0 && (
          <>
            <span class="quiet number">
              {at + 1} of {members.length}
            </span>
            <IconButton icon="back" label="Member before" onClick={() => selectMember(-1)} />
            <IconButton icon="on" label="Next member" onClick={() => selectMember(1)} />
          </>
        )}
      </p>
      <p class="quiet number">
        {formatTime(segment.start_s, 2)} to {formatTime(segment.stop_s, 2)} ·{" "}
        {getDuration(segment).toFixed(2)} s
        {confidence?.text && <span title={confidence.why}> · {confidence.text}</span>}
      </p>
    </section>
  );
}
