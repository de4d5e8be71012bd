/** Which tiles of the similarity pyramid a view needs, and where they lie. Pure functions. */
import type { MatrixHead } from "../messages";
import type { Span } from "../view";

/** A tile by its place: `row` down, `column` across. */
export interface Place {
  level: number;
  row: number;
  column: number;
}

/** Seconds that one cell of a level stands for. */
export function cellSeconds(head: MatrixHead, level: number): number {
  return 2 ** level / head.fps;
}

/** The level whose cells are about as large as a pixel of the screen. */
export function levelFor(head: MatrixHead, secondsPerPixel: number): number {
  const level = Math.round(Math.log2(Math.max(secondsPerPixel * head.fps, 1e-9)));
  return Math.min(Math.max(level, 0), head.sizes.length - 1);
}

/** The tiles of a level that two spans of time cover. */
export function tilesFor(head: MatrixHead, level: number, down: Span, across: Span): Place[] {
  const seconds = cellSeconds(head, level) * head.tile;
  const last = Math.max(Math.ceil((head.sizes[level] ?? 0) / head.tile) - 1, 0);
  const indices = ({ start_s, stop_s }: Span): number[] => {
    const from = Math.max(Math.floor(start_s / seconds), 0);
    const to = Math.min(Math.max(Math.ceil(stop_s / seconds) - 1, from), last);
    return Array.from({ length: to - from + 1 }, (_, i) => from + i);
  };
  return indices(down).flatMap((row) => indices(across).map((column) => ({ level, row, column })));
}

/** The tile of the next coarser level that covers a tile. */
export function parentOf({ level, row, column }: Place): Place {
  return { level: level + 1, row: row >> 1, column: column >> 1 };
}

/** The same or its mirror image on or below the diagonal, where the tiles of a report lie. */
export function storedPlace(place: Place): { place: Place; mirrored: boolean } {
  const { level, row, column } = place;
  if (row >= column) return { place, mirrored: false };
  return { place: { level, row: column, column: row }, mirrored: true };
}

/** Rows of the matrix to show: as many as columns, from where the user moved them. */
export function rowsFor(moved: Span | null, columns: Span): Span {
  if (!moved) return columns;
  const same = moved.stop_s - moved.start_s - (columns.stop_s - columns.start_s);
  return Math.abs(same) < 1e-6 * (columns.stop_s - columns.start_s) ? moved : columns;
}
