/** Compute which tiles of the similarity pyramid a view needs. Pure functions. */
import type { MatrixHead } from "../messages";
import type { Span } from "../view";

/** Position of a tile in the pyramid. */
export interface TilePosition {
  level: number;
  row: number;
  column: number;
}

/** Return the seconds that one cell of a level covers. */
export function getCellDuration(head: MatrixHead, level: number): number {
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
