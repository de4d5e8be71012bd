/** Tiles as pictures in the page's colours, loaded when they are first asked for. */
import { signal } from "@preact/signals";
import { channelsOf } from "../colors";
import type { RecordingData } from "../recordingData";
import { cssColor, type Theme } from "../theme";
import type { Place } from "./pyramid";

const MOST = 240; // tiles in memory, a third of a megabyte each
const AT_ONCE = 6;

interface Tile {
  /** How similar, from 0 to 255. */
  grey: Uint8Array;
  picture: OffscreenCanvas;
}

export class Tiles {
  /** Grows whenever a tile has come. */
  readonly arrived = signal(0);
  private readonly pictures = new Map<string, Tile | null>();
  private readonly waiting = new Map<string, Place>();
  private loading = 0;
  private shades = shadesOfPage();
  private theme: Theme | null = null;

  constructor(private readonly data: RecordingData) {}

  /** The picture of a tile; undefined while it is on its way, null where there is none. */
  get(place: Place): OffscreenCanvas | null | undefined {
    const key = `${place.level}/${place.row}/${place.column}`;
    const tile = this.pictures.get(key);
    if (tile !== undefined) {
      this.pictures.delete(key); // to the end: the first ones are forgotten first
      this.pictures.set(key, tile);
      return tile && tile.picture;
    }
    if (!this.waiting.has(key)) {
      this.waiting.set(key, place);
      void this.load();
    }
    return undefined;
  }

  /** Forgets what has not been asked for since the last call, so that it does not come first. */
  forgetQueue(): void {
    this.waiting.clear();
  }

  /** Puts all tiles into the colours of a theme at once, as paper does not wait. */
  colorFor(theme: Theme): void {
    if (theme === this.theme) return;
    this.theme = theme;
    this.shades = shadesOfPage();
    for (const tile of this.pictures.values()) if (tile) paint(tile, this.shades);
  }

  private async load(): Promise<void> {
    if (this.loading >= AT_ONCE) return;
    const next = this.waiting.entries().next().value;
    if (!next) return;
    const [key, { level, row, column }] = next;
    this.waiting.delete(key);
    this.loading += 1;
    try {
      const blob = await this.data.tile(level, row, column);
      const tile = blob && (await decoded(blob));
      if (tile) paint(tile, this.shades);
      this.store(key, tile);
    } catch {
      this.store(key, null); // a coarser tile is shown in its place
    } finally {
      this.loading -= 1;
    }
    this.arrived.value += 1;
    void this.load();
  }

  private store(key: string, tile: Tile | null): void {
    this.pictures.set(key, tile);
    const first = this.pictures.keys().next().value;
    if (this.pictures.size > MOST && first !== undefined) this.pictures.delete(first);
  }
}

async function decoded(blob: Blob): Promise<Tile> {
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

/** Grey becomes the colour between those of unlike and equal. */
function paint({ grey, picture }: Tile, shades: Uint8ClampedArray): void {
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

function shadesOfPage(): Uint8ClampedArray {
  const low = channelsOf(cssColor("matrix-low"));
  const high = channelsOf(cssColor("matrix-high"));
  const shades = new Uint8ClampedArray(3 * 256);
  for (let grey = 0; grey < 256; grey++)
    for (let c = 0; c < 3; c++)
      shades[3 * grey + c] = low[c]! + (grey / 255) * (high[c]! - low[c]!);
  return shades;
}
