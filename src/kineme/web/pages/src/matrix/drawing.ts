/** How the matrix looks: tiles, and over them the segments and what is selected. */
import type { MatrixHead, Segment } from "../messages";
import type { Store } from "../store";
import { cssColor } from "../theme";
import { visible } from "../timeline/lanes";
import { toPixel, type Span } from "../view";
import { cellSeconds, storedPlace, levelFor, parentOf, tilesFor, type Place } from "./pyramid";
import type { Tiles } from "./tiles";

type Pen = CanvasRenderingContext2D;

/** Pixels at the upper and the left edge for the colours of the activities. */
export const EDGE = 9;
const SMOOTH_BELOW = 3; // pixels per cell; larger ones are drawn as squares

/** What is shown: `side` pixels of `down` and `across`, to the right and below of the edge. */
export interface Frame {
  side: number;
  down: Span;
  across: Span;
}

export function drawMatrix(
  pen: Pen,
  head: MatrixHead,
  tiles: Tiles,
  frame: Frame,
  store: Store,
): void {
  const { side, down, across } = frame;
  pen.save();
  pen.translate(EDGE, EDGE);
  pen.beginPath();
  pen.rect(0, 0, side, side);
  pen.clip();
  pen.fillStyle = cssColor("matrix-low");
  pen.fillRect(0, 0, side, side);
  const perPixel = (across.stop_s - across.start_s) / (side * devicePixelRatio);
  const level = levelFor(head, perPixel);
  pen.imageSmoothingEnabled = cellSeconds(head, level) / perPixel < SMOOTH_BELOW * devicePixelRatio;
  tiles.forgetQueue();
  for (const place of tilesFor(head, level, down, across)) drawTile(pen, head, tiles, place, frame);
  drawSquares(pen, frame, store);
  drawSelected(pen, frame, store);
  pen.restore();
  drawEdges(pen, frame, store);
}

/** A tile, or the part of a coarser one that stands in for it. */
function drawTile(pen: Pen, head: MatrixHead, tiles: Tiles, target: Place, frame: Frame): void {
  for (let place = target; place.level < head.sizes.length; place = parentOf(place)) {
    const stored = storedPlace(place);
    const picture = tiles.get(stored.place);
    if (!picture) continue;
    pen.save();
    clipTo(pen, head, target, frame);
    const seconds = cellSeconds(head, place.level);
    const { start_s, stop_s } = frame.across;
    const scale = (frame.side / (stop_s - start_s)) * seconds; // pixels per cell
    const x = toPixel(frame.across, frame.side, place.column * head.tile * seconds);
    const y = toPixel(frame.down, frame.side, place.row * head.tile * seconds);
    pen.translate(x, y);
    if (stored.mirrored) pen.transform(0, 1, 1, 0, 0, 0);
    pen.drawImage(picture, 0, 0, picture.width * scale, picture.height * scale);
    pen.restore();
    return;
  }
}

function clipTo(pen: Pen, head: MatrixHead, place: Place, { side, down, across }: Frame): void {
  const seconds = cellSeconds(head, place.level) * head.tile;
  const edge = (span: Span, index: number): number =>
    Math.round(toPixel(span, side, index * seconds));
  const [x, y] = [edge(across, place.column), edge(down, place.row)];
  pen.beginPath();
  pen.rect(x, y, edge(across, place.column + 1) - x, edge(down, place.row + 1) - y);
  pen.clip();
}

/** Activities and primitives are squares on the diagonal. */
function drawSquares(pen: Pen, frame: Frame, store: Store): void {
  const hovered = store.hovered.value;
  for (const [lane, width] of [
    [store.primitives.value, 1],
    [store.activities.value, 1.75],
  ] as const) {
    const [from, to] = visible(lane, frame.across.start_s, frame.across.stop_s);
    for (const segment of lane.slice(from, to)) {
      const color = store.colorOf(segment);
      if (!color) continue;
      const box = boxOf(segment, segment, frame);
      if (box[2] < 3) continue;
      const thick = hovered !== null && segment.cluster === hovered ? width + 1.5 : width;
      pen.strokeStyle = cssColor("page");
      pen.lineWidth = thick + 1.5;
      pen.strokeRect(...box);
      pen.strokeStyle = color;
      pen.lineWidth = thick;
      pen.strokeRect(...box);
    }
  }
}

/** The selected segment as a cross of bands, and boxes where it meets its likes. */
function drawSelected(pen: Pen, frame: Frame, store: Store): void {
  const selected = store.selected.value;
  if (!selected) return;
  const { side } = frame;
  const [x, y, width, height] = boxOf(selected, selected, frame);
  pen.fillStyle = cssColor("accent");
  pen.globalAlpha = 0.22;
  pen.fillRect(x, 0, width, side);
  pen.fillRect(0, y, side, height);
  pen.globalAlpha = 1;
  pen.strokeStyle = cssColor("accent");
  pen.lineWidth = 1;
  const lane = selected.level === "activity" ? store.activities.value : store.primitives.value;
  for (const other of lane) {
    if (other.cluster !== selected.cluster || other.cluster < 0) continue;
    for (const box of [boxOf(selected, other, frame), boxOf(other, selected, frame)])
      if (box[2] >= 2 && box[3] >= 2) pen.strokeRect(...box);
  }
}

function boxOf(
  row: Segment,
  column: Segment,
  { side, down, across }: Frame,
): [number, number, number, number] {
  const x = toPixel(across, side, column.start_s);
  const y = toPixel(down, side, row.start_s);
  return [x, y, toPixel(across, side, column.stop_s) - x, toPixel(down, side, row.stop_s) - y];
}

function drawEdges(pen: Pen, { side, down, across }: Frame, store: Store): void {
  for (const segment of store.activities.value) {
    const { start_s, stop_s } = segment;
    const color = store.colorOf(segment);
    if (!color) continue;
    pen.fillStyle = color;
    const inside = (span: Span, seconds: number): number =>
      EDGE + Math.min(Math.max(toPixel(span, side, seconds), 0), side);
    const [x, y] = [inside(across, start_s), inside(down, start_s)];
    pen.fillRect(x, 1, inside(across, stop_s) - x, EDGE - 3);
    pen.fillRect(1, y, EDGE - 3, inside(down, stop_s) - y);
  }
}
