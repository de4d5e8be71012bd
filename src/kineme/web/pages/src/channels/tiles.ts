/** The curves of a recording in tiles, asked for when they are looked at; the last ones are kept. */
import { signal } from "@preact/signals";
import type { CurveList } from "../messages";
import type { RecordingData } from "../recordingData";

const MOST = 2000; // tiles of 8 kB

export class CurveTiles {
  /** Grows with each tile that came. */
  readonly arrived = signal(0);
  /** Grows whenever all that was asked for has come. */
  readonly settled = signal(0);
  private pending = 0;
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
    this.pending += 1;
    void this.data
      .curveTile(curve, level, number)
      .then(
        (bytes) => this.arrive(key, new Float32Array(bytes ?? new ArrayBuffer(0))),
        () => this.recent.delete(key), // asked for again when it is looked at again
      )
      .finally(() => {
        this.pending -= 1;
        if (this.pending === 0) this.settled.value += 1;
      });
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

  /** The value at a frame, or between the two beside it; NaN while it is not known. */
  near(curve: number, frame: number): number {
    const before = Math.max(Math.floor(frame), 0);
    const share = Math.max(frame - before, 0);
    const [a, b] = [this.middle(curve, before), share > 1e-6 ? this.middle(curve, before + 1) : 0];
    return share > 1e-6 && !Number.isNaN(b) ? a + share * (b - a) : a;
  }

  /** Between the least and the greatest value of a frame, of the finest level that there is. */
  private middle(curve: number, frame: number): number {
    const { tile, factor, levels } = this.list;
    for (let level = 0, bin = frame; level < levels; level++, bin = Math.floor(bin / factor)) {
      const pairs = this.get(curve, level, Math.floor(bin / tile));
      if (!pairs) return NaN;
      const at = 2 * (bin % tile);
      if (pairs.length > at) return (pairs[at]! + pairs[at + 1]!) / 2;
      if (pairs.length) return NaN; // after the end
    }
    return NaN;
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
