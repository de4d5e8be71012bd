/** Tiles as pictures in the page's colours, loaded when they are first asked for. */
import { signal } from "@preact/signals";
import { channelsOf } from "../colors";
import type { RecordingData } from "../recordingData";
import { cssColor } from "../theme";
import type { Place } from "./pyramid";

const MOST = 240; // tiles in memory, a quarter of a megabyte each
const AT_ONCE = 6;

export class Tiles {
  /** Grows whenever a tile has come. */
  readonly arrived = signal(0);
  private readonly pictures = new Map<string, OffscreenCanvas | null>();
  private readonly waiting = new Map<string, Place>();
  private loading = 0;
  private shades = shadesOfPage();

  constructor(private readonly data: RecordingData) {}

  /** The picture of a tile; undefined while it is on its way, null where there is none. */
  get(place: Place): OffscreenCanvas | null | undefined {
    const key = `${place.level}/${place.row}/${place.column}`;
    const picture = this.pictures.get(key);
    if (picture !== undefined) {
      this.pictures.delete(key); // to the end: the first ones are forgotten first
      this.pictures.set(key, picture);
      return picture;
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

  /** Draws all tiles anew in the present colours. */
  recolor(): void {
    this.shades = shadesOfPage();
    this.pictures.clear();
  }

  private async load(): Promise<void> {
    if (this.loading >= AT_ONCE) return;
    const next = this.waiting.entries().next().value;
    if (!next) return;
    const [key, { level, row, column }] = next;
    this.waiting.delete(key);
    this.loading += 1;
    const { shades } = this;
    try {
      const blob = await this.data.tile(level, row, column);
      const picture = blob && (await colored(blob, shades));
      if (shades === this.shades) this.store(key, picture);
    } catch {
      this.store(key, null); // a coarser tile is shown in its place
    } finally {
      this.loading -= 1;
    }
    this.arrived.value += 1;
    void this.load();
  }

  private store(key: string, picture: OffscreenCanvas | null): void {
    this.pictures.set(key, picture);
    const first = this.pictures.keys().next().value;
    if (this.pictures.size > MOST && first !== undefined) this.pictures.delete(first);
  }
}

/** Grey becomes the colour between those of unlike and equal. */
async function colored(blob: Blob, shades: Uint8ClampedArray): Promise<OffscreenCanvas> {
  const bitmap = await createImageBitmap(blob);
  const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
  const pen = canvas.getContext("2d", { willReadFrequently: true })!;
  pen.drawImage(bitmap, 0, 0);
  bitmap.close();
  const pixels = pen.getImageData(0, 0, canvas.width, canvas.height);
  const { data } = pixels;
  for (let i = 0; i < data.length; i += 4) {
    const grey = 3 * data[i]!;
    data[i] = shades[grey]!;
    data[i + 1] = shades[grey + 1]!;
    data[i + 2] = shades[grey + 2]!;
  }
  pen.putImageData(pixels, 0, 0);
  return canvas;
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
