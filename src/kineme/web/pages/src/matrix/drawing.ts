/** Draw the matrix: tiles, then segments and the selection. */
import type { MatrixHead, Segment } from "../messages";
import type { Store } from "../store";
import { readColor } from "../theme";
import { findVisible } from "../timeline/lanes";
import { toPixel, type Span } from "../view";
import {
  getCellDuration,
  findStoredTile,
  chooseLevel,
  getParent,
  listTiles,
  type TilePosition,
} from "./pyramid";
import type { MatrixTiles } from "./tiles";

type Pen = CanvasRenderingContext2D;

/** Width in pixels of the activity colours along the upper and left edges. */
export const EDGE = 9;
const SMOOTH_BELOW = 3; // smooth cells below this many pixels, draw larger ones as squares

/** The visible part: `side` pixels show `down` and `across`, right of and below the edge. */
interface View {
  side: number;
  down: Span;
  across: Span;
}

export function drawMatrix(
  pen: Pen,
  head: MatrixHead,
  tiles: MatrixTiles,
  frame: View,
  store: Store,
): void {
  const { side, down, across } = frame;
  pen.save();
  pen.translate(EDGE, EDGE);
  pen.beginPath();
  pen.rect(0, 0, side, side);
  pen.clip();
  pen.fillStyle = readColor("matrix-low");
  pen.fillRect(0, 0, side, side);
  const perPixel = (across.stop_s - across.start_s) / (side * devicePixelRatio);
  const level = chooseLevel(head, perPixel);
  pen.imageSmoothingEnabled =
    getCellDuration(head, level) / perPixel < SMOOTH_BELOW * devicePixelRatio;
  tiles.clearQueue();
  for (const place of listTiles(head, level, down, across))
    drawTile(pen, head, tiles, place, frame);
  drawSquares(pen, frame, store);
  drawSelected(pen, frame, store);
  pen.restore();
  drawEdges(pen, frame, store);
}

/** Draw a tile, or the part of a coarser tile that covers it. */
function drawTile(
  pen: Pen,
  head: MatrixHead,
  tiles: MatrixTiles,
  target: TilePosition,
  frame: View,
): void {
  for (let place = target; place.level < head.sizes.length; place = getParent(place)) {
    const stored = findStoredTile(place);
    const picture = tiles.get(stored.place);
    if (!picture) continue;
    pen.save();
    clipToTile(pen, head, target, frame);
    const seconds = getCellDuration(head, place.level);
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

function clipToTile(
  pen: Pen,
  head: MatrixHead,
  place: TilePosition,
  { side, down, across }: View,
): void {
  const seconds = getCellDuration(head, place.level) * head.tile;
  const edge = (span: Span, index: number): number =>
    Math.round(toPixel(span, side, index * seconds));
  const [x, y] = [edge(across, place.column), edge(down, place.row)];
  pen.beginPath();
  pen.rect(x, y, edge(across, place.column + 1) - x, edge(down, place.row + 1) - y);
  pen.clip();
}

/** Draw activities and primitives as squares on the diagonal. */
function drawSquares(pen: Pen, frame: View, store: Store): void {
  const hovered = store.hovered.value;
  for (const [lane, width] of [
    [store.primitives.value, 1],
    [store.activities.value, 1.75],
  ] as const) {
    const [from, to] = findVisible(lane, frame.across.start_s, frame.across.stop_s);
    for (const segment of lane.slice(from, to)) {
      const color = store.getColor(segment);
      if (!color) continue;
      const box = getBox(segment, segment, frame);
      if (box[2] < 3) continue;
      const thick = hovered !== null && segment.cluster === hovered ? width + 1.5 : width;
      pen.strokeStyle = readColor("page");
      pen.lineWidth = thick + 1.5;
      pen.strokeRect(...box);
      pen.strokeStyle = color;
      pen.lineWidth = thick;
      pen.strokeRect(...box);
    }
  }
}

/** Draw the selected segment as crossing bands, with boxes where it meets its cluster's members. */
function drawSelected(pen: Pen, frame: View, store: Store): void {
  const selected = store.selected.value;
  if (!selected) return;
  const { side } = frame;
  const [x, y, width, height] = getBox(selected, selected, frame);
  pen.fillStyle = readColor("accent");
  pen.globalAlpha = 0.22;
  pen.fillRect(x, 0, width, side);
  pen.fillRect(0, y, side, height);
  pen.globalAlpha = 1;
  pen.strokeStyle = readColor("accent");
  pen.lineWidth = 1;
  const lane = selected.level === "activity" ? store.activities.value : store.primitives.value;
  for (const other of lane) {
    if (other.cluster !== selected.cluster || other.cluster < 0) continue;
    for (const box of [getBox(selected, other, frame), getBox(other, selected, frame)])
      if (box[2] >= 2 && box[3] >= 2) pen.strokeRect(...box);
  }
}

function getBox(
  row: Segment,
  column: Segment,
  { side, down, across }: View,
): [number, number, number, number] {
  const x = toPixel(across, side, column.start_s);
  const y = toPixel(down, side, row.start_s);
  return [x, y, toPixel(across, side, column.stop_s) - x, toPixel(down, side, row.stop_s) - y];
}

function drawEdges(pen: Pen, { side, down, across }: View, store: Store): void {
  for (const segment of store.activities.value) {
    const { start_s, stop_s } = segment;
    const color = store.getColor(segment);
    if (!color) continue;
    pen.fillStyle = color;
    const inside = (span: Span, seconds: number): number =>
      EDGE + Math.min(Math.max(toPixel(span, side, seconds), 0), side);
    const [x, y] = [inside(across, start_s), inside(down, start_s)];
    pen.fillRect(x, 1, inside(across, stop_s) - x, EDGE - 3);
    pen.fillRect(1, y, EDGE - 3, inside(down, stop_s) - y);
  }
}
