/** The curves of a recording in tiles, asked for when they are looked at; the last ones are kept. */
import { signal } from "@preact/signals";
import type { CurveList } from "../messages";
import type { RecordingData } from "../recordingData";

const MOST = 2000; // tiles of 8 kB

export class CurveTiles {
  /** Grows with each tile that came. */
  readonly arrived = signal(0);
  private readonly recent = new Map<string, Float32Array | null>();

  constructor(
    /** Of the recording that these are the curves of. */
    readonly data: RecordingData,
    readonly list: CurveList,
  ) {}

  /** Pairs of least and greatest values; null while they are on their way. */
  get(curve: number, level: number, number: number): Float32Array | null {
    const key = `${curve} ${level} ${number}`;
    const recent = this.recent.get(key);
    if (recent !== undefined) return recent;
    this.recent.set(key, null);
    void this.data.curveTile(curve, level, number).then(
      (bytes) => this.arrive(key, new Float32Array(bytes ?? new ArrayBuffer(0))),
      () => this.recent.delete(key), // asked for again when it is looked at again
    );
    return null;
  }

  /** The least and the greatest value of all; null until they are known. */
  bounds(curve: number): [number, number] | null {
    const pairs = this.get(curve, this.list.levels - 1, 0);
    if (!pairs) return null;
    const finite = pairs.filter((value) => !Number.isNaN(value));
    let [low, high] = [Infinity, -Infinity];
    for (const value of finite) [low, high] = [Math.min(low, value), Math.max(high, value)];
    return finite.length ? [low, high] : [0, 1];
  }

  /** The value at a frame; null while it is not known, NaN where nothing was seen. */
  at(curve: number, frame: number): number | null {
    const { tile } = this.list;
    const pairs = this.get(curve, 0, Math.floor(frame / tile));
    return pairs?.length ? (pairs[2 * (frame % tile)] ?? NaN) : null;
  }

  private arrive(key: string, pairs: Float32Array): void {
    for (const old of this.recent.keys()) {
      if (this.recent.size <= MOST) break;
      this.recent.delete(old);
    }
    this.recent.set(key, pairs);
    this.arrived.value += 1;
  }
}
