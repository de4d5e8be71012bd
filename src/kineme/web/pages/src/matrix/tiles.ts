/** Load matrix tiles on demand and colour them for the theme. */
import { signal } from "@preact/signals";
import { parseColor } from "../colors";
import type { RecordingData } from "../recordingData";
import { readColor, type Theme } from "../theme";
import type { TilePosition } from "./pyramid";

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
  private readonly cache = new Map<string, Tile | null>();
  private readonly queue = new Map<string, TilePosition>();
  private loading = 0;
  private shades = computeShades();
  private theme: Theme | null = null;

  constructor(private readonly data: RecordingData) {}

  /** Return a tile's picture; undefined while loading, null if there is none. */
  get(place: TilePosition): OffscreenCanvas | null | undefined {
    const key = `${place.level}/${place.row}/${place.column}`;
    const tile = this.cache.get(key);
    if (tile !== undefined) {
      this.cache.delete(key); // move to the end: the first ones are dropped first
      this.cache.set(key, tile);
      return tile && tile.picture;
    }
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
      this.storeTile(key, tile);
    } catch {
      this.storeTile(key, null); // a coarser tile replaces it
    } finally {
      this.loading -= 1;
    }
    this.loadCount.value += 1;
    void this.load();
  }

  private storeTile(key: string, tile: Tile | null): void {
    this.cache.set(key, tile);
    const first = this.cache.keys().next().value;
    if (this.cache.size > MAX_TILES && first !== undefined) this.cache.delete(first);
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

/** Map similarity to a colour between those of different and equal. */
function colorTile({ grey, picture }: Tile, shades: Uint8ClampedArray): void {
  const pixels = new ImageData(picture.width, picture.height);
  const { data } = pixels;
  for (let i = 0; i < grey.length; i++) {
    const shade = 3 * grey[i]!;
    data[4 * i] = shades[shade]!;
    data[4 * i + 1] = shades[shade + 1]!;
    data[4 * i + 2] = shades[shade + 2]!;
    data[4 * i + 3] = 255;
  }
  picture.getContext("2d")!.putImageData(pixels, 0, 0);
}

function computeShades(): Uint8ClampedArray {
  const low = parseColor(readColor("matrix-low"));
  const high = parseColor(readColor("matrix-high"));
  const shades = new Uint8ClampedArray(3 * 256);
  for (let grey = 0; grey < 256; grey++)
    for (let c = 0; c < 3; c++)
      shades[3 * grey + c] = low[c]! + (grey / 255) * (high[c]! - low[c]!);
  return shades;
}
