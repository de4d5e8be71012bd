/** Draw the matrix: load and colour its tiles, then draw segments and the selection over them. */
import { signal } from "@preact/signals";
import { parseColor } from "../colors";
import { drawInside, type Pen, readColor, type Theme } from "../drawing";
import type { MatrixHead, Segment } from "../messages";
import type { RecordingData } from "../recordingData";
import type { Store } from "../store";
import { RecentMap } from "../util";
import { toPixel, type Span } from "../view";
import { findVisible } from "./lanes";

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
  const perPixel = (across.stop_s - across.start_s) / (side * devicePixelRatio);
  const level = chooseLevel(head, perPixel);
  drawInside(pen, [EDGE, EDGE, side, side], () => {
    pen.translate(EDGE, EDGE);
    pen.fillStyle = readColor("matrix-low");
    pen.fillRect(0, 0, side, side);
    pen.imageSmoothingEnabled =
      getCellDuration(head, level) / perPixel < SMOOTH_BELOW * devicePixelRatio;
    tiles.clearQueue();
    for (const place of listTiles(head, level, down, across))
      drawTile(pen, head, tiles, place, frame);
    drawSquares(pen, frame, store);
    drawSelected(pen, frame, store);
  });
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
    const seconds = getCellDuration(head, place.level);
    const { start_s, stop_s } = frame.across;
    const scale = (frame.side / (stop_s - start_s)) * seconds; // pixels per cell
    const x = toPixel(frame.across, frame.side, place.column * head.tile * seconds);
    const y = toPixel(frame.down, frame.side, place.row * head.tile * seconds);
    drawInside(pen, getTileBox(head, target, frame), () => {
      pen.translate(x, y);
      if (stored.mirrored) pen.transform(0, 1, 1, 0, 0, 0);
      pen.drawImage(picture, 0, 0, picture.width * scale, picture.height * scale);
    });
    return;
  }
}

function getTileBox(
  head: MatrixHead,
  place: TilePosition,
  { side, down, across }: View,
): [number, number, number, number] {
  const seconds = getCellDuration(head, place.level) * head.tile;
  const edge = (span: Span, index: number): number =>
    Math.round(toPixel(span, side, index * seconds));
  const [x, y] = [edge(across, place.column), edge(down, place.row)];
  return [x, y, edge(across, place.column + 1) - x, edge(down, place.row + 1) - y];
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

/** Position of a tile in the pyramid. */
interface TilePosition {
  level: number;
  row: number;
  column: number;
}

/** Return the seconds that one cell of a level covers. */
function getCellDuration(head: MatrixHead, level: number): number {
  return 2 ** level / head.fps;
}

/** Return the level whose cells are closest to a pixel in size. */
export function chooseLevel(head: MatrixHead, secondsPerPixel: number): number {
  const level = Math.round(Math.log2(Math.max(secondsPerPixel * head.fps, 1e-9)));
  return Math.min(Math.max(level, 0), head.sizes.length - 1);
}

/** Return the tiles of a level that two time spans cover. */
export function listTiles(
  head: MatrixHead,
  level: number,
  down: Span,
  across: Span,
): TilePosition[] {
  const seconds = getCellDuration(head, level) * head.tile;
  const last = Math.max(Math.ceil((head.sizes[level] ?? 0) / head.tile) - 1, 0);
  const indices = ({ start_s, stop_s }: Span): number[] => {
    const from = Math.max(Math.floor(start_s / seconds), 0);
    const to = Math.min(Math.max(Math.ceil(stop_s / seconds) - 1, from), last);
    return Array.from({ length: to - from + 1 }, (_, i) => from + i);
  };
  return indices(down).flatMap((row) => indices(across).map((column) => ({ level, row, column })));
}

/** Return the tile of the next coarser level that covers a tile. */
export function getParent({ level, row, column }: TilePosition): TilePosition {
  return { level: level + 1, row: row >> 1, column: column >> 1 };
}

/** Return the tile or its mirror image below the diagonal: reports store only that half. */
export function findStoredTile(place: TilePosition): { place: TilePosition; mirrored: boolean } {
  const { level, row, column } = place;
  if (row >= column) return { place, mirrored: false };
  return { place: { level, row: column, column: row }, mirrored: true };
}

/** Return the rows to show, as long as the columns; the user may have moved them. */
export function chooseRows(moved: Span | null, columns: Span): Span {
  if (!moved) return columns;
  const same = moved.stop_s - moved.start_s - (columns.stop_s - columns.start_s);
  return Math.abs(same) < 1e-6 * (columns.stop_s - columns.start_s) ? moved : columns;
}

const MAX_TILES = 240; // of 0.3 MB each
const MAX_CONCURRENT = 6;

interface Tile {
  /** Similarity from 0 to 255. */
  grey: Uint8Array;
  picture: OffscreenCanvas;
}

export class MatrixTiles {
  /** Number of loaded tiles; redraws depend on it. */
  readonly loadCount = signal(0);
  private readonly cache = new RecentMap<Tile | null>(MAX_TILES);
  private readonly queue = new Map<string, TilePosition>();
  private loading = 0;
  private shades = computeShades();
  private theme: Theme | null = null;

  constructor(private readonly data: RecordingData) {}

  /** Return a tile's picture; undefined while loading, null if there is none. */
  get(place: TilePosition): OffscreenCanvas | null | undefined {
    const key = `${place.level}/${place.row}/${place.column}`;
    const tile = this.cache.get(key);
    if (tile !== undefined) return tile && tile.picture;
    if (!this.queue.has(key)) {
      this.queue.set(key, place);
      void this.load();
    }
    return undefined;
  }

  /** Drop requests that wait from an earlier draw, so that current ones come first. */
  clearQueue(): void {
    this.queue.clear();
  }

  /** Recolour all tiles at once, since printing does not wait. */
  applyTheme(theme: Theme): void {
    if (theme === this.theme) return;
    this.theme = theme;
    this.shades = computeShades();
    for (const tile of this.cache.values()) if (tile) colorTile(tile, this.shades);
  }

  private async load(): Promise<void> {
    if (this.loading >= MAX_CONCURRENT) return;
    const next = this.queue.entries().next().value;
    if (!next) return;
    const [key, { level, row, column }] = next;
    this.queue.delete(key);
    this.loading += 1;
    try {
      const blob = await this.data.loadTile(level, row, column);
      const tile = blob && (await decodeTile(blob));
      if (tile) colorTile(tile, this.shades);
      this.cache.set(key, tile);
    } catch {
      this.cache.set(key, null); // a coarser tile replaces it
    } finally {
      this.loading -= 1;
    }
    this.loadCount.value += 1;
    void this.load();
  }
}

async function decodeTile(blob: Blob): Promise<Tile> {
  const bitmap = await createImageBitmap(blob);
  const picture = new OffscreenCanvas(bitmap.width, bitmap.height);
  const pen = picture.getContext("2d", { willReadFrequently: true })!;
  pen.drawImage(bitmap, 0, 0);
  bitmap.close();
  const { data } = pen.getImageData(0, 0, picture.width, picture.height);
  const grey = new Uint8Array(data.length / 4);
  for (let i = 0; i < grey.length; i++) grey[i] = data[4 * i]!;
  return { grey, picture };
}

function colorTile({ grey, picture }: Tile, shades: Uint32Array): void {
  const pixels = new ImageData(picture.width, picture.height);
  const colors = new Uint32Array(pixels.data.buffer);
  grey.forEach((each, i) => (colors[i] = shades[each]!));
  picture.getContext("2d")!.putImageData(pixels, 0, 0);
}

/** Return the colour of each similarity, between those of different and equal, as one pixel. */
function computeShades(): Uint32Array {
  const low = parseColor(readColor("matrix-low"));
  const high = parseColor(readColor("matrix-high"));
  const shades = new Uint8ClampedArray(4 * 256).fill(255);
  for (let grey = 0; grey < 256; grey++)
    low.forEach((from, c) => (shades[4 * grey + c] = from + (grey / 255) * (high[c]! - from)));
  return new Uint32Array(shades.buffer);
}
