/** Show the self-similarity matrix; similar frames are bright. */
import { useMemo } from "preact/hooks";
import { useStore, type Store } from "../store";
import {
  CLICK_TOLERANCE,
  Canvas,
  PlayheadLine,
  moveFinger,
  getPosition,
  getZoomFactor,
  theme,
  type Point,
  type Touches,
} from "../drawing";
import { formatTime, panRange, toPixel, toSeconds, zoomRange, type Span } from "../view";
import { EDGE, MatrixTiles, chooseRows, drawMatrix } from "./matrixDrawing";
import { findSegmentAt, getDuration, getSegmentName } from "../segments";
import { IconButton, Swatch } from "../layout/controls";
import { Confidence } from "../confidence";
import { computed, signal, type ReadonlySignal } from "@preact/signals";

function Matrix() {
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
            void [store.labelColors.value, store.range.value, store.hovered.value];
            void [rows.value, tiles.loadCount.value];
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
function CurrentSegment() {
  const store = useStore();
  const segment = store.present.value;
  if (!segment) return null;
  const table = store.recording.value?.segmentation;
  const confidence = table && new Confidence(table, segment);
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
        <Swatch color={store.getColor(segment)} />
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

/** Handle pointers on the matrix: seek, pan and zoom. */
class MatrixGestures {
  /** The two times at the pointer, in seconds; null outside. */
  readonly pointer = signal<Point | null>(null);
  /** Time span from top to bottom; the timeline's range is shown from left to right. */
  readonly rows: ReadonlySignal<Span>;
  private readonly movedRows = signal<Span | null>(null);
  private readonly touches: Touches = new Map();
  private pressed: { place: Point; last: Point; far: boolean } | null = null;

  constructor(private readonly store: Store) {
    this.rows = computed(() => chooseRows(this.movedRows.value, store.range.value));
  }

  down(event: PointerEvent): void {
    const place = getPosition(event);
    (event.currentTarget as Element).setPointerCapture(event.pointerId);
    this.touches.set(event.pointerId, place);
    this.pressed = this.touches.size > 1 ? null : { place, last: place, far: false };
  }

  move(event: PointerEvent): void {
    const place = getPosition(event);
    const side = getSide(event);
    this.pointer.value = this.getTimesAt(place, side);
    const pinch = moveFinger(this.touches, event.pointerId, place);
    if (pinch) {
      this.zoom(pinch.factor, this.getTimesAt(pinch.from, side));
      this.pan(pinch.from, pinch.to, side);
    }
    const { pressed } = this;
    if (!pressed) return;
    const from = pressed.place;
    pressed.far ||= Math.hypot(place.x - from.x, place.y - from.y) >= CLICK_TOLERANCE;
    if (!pressed.far) return;
    this.pan(pressed.last, place, side);
    pressed.last = place;
  }

  up(event: PointerEvent): void {
    const clicked = this.pressed && !this.pressed.far;
    this.pressed = null;
    this.touches.delete(event.pointerId);
    if (!clicked) return;
    const { x } = this.getTimesAt(getPosition(event), getSide(event));
    const segment = findSegmentAt(this.store.primitives.value, this.store.getFrameAt(x));
    if (segment) this.store.select(segment, { seek: false });
    this.store.seek(x);
  }

  cancel(): void {
    this.pressed = null;
    this.touches.clear();
  }

  leave(): void {
    this.pointer.value = null;
  }

  wheel(event: WheelEvent): void {
    this.zoom(getZoomFactor(event), this.getTimesAt(getPosition(event), getSide(event)));
  }

  private zoom(factor: number, at: Point): void {
    const next = zoomRange(this.rows.value, factor, at.y, this.store.duration.value);
    this.store.zoomBy(factor, at.x);
    this.movedRows.value = this.store.zoom.value ? next : null;
  }

  private pan(from: Point, to: Point, side: number): void {
    if (!this.store.zoom.value) return;
    const [before, after] = [this.getTimesAt(from, side), this.getTimesAt(to, side)];
    this.movedRows.value = panRange(this.rows.value, before.y - after.y, this.store.duration.value);
    this.store.panBy(before.x - after.x);
  }

  private getTimesAt({ x, y }: Point, side: number): Point {
    return {
      x: toSeconds(this.store.range.value, side, x - EDGE),
      y: toSeconds(this.rows.value, side, y - EDGE),
    };
  }
}

/** Return the side of the drawn square in pixels. */
function getSide(event: MouseEvent): number {
  return (event.currentTarget as Element).clientWidth - EDGE;
}
