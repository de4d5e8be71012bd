/** The curves of a recording in pieces, asked for when they are looked at; the last ones are kept. */
import { signal } from "@preact/signals";
import type { CurveList } from "../messages";
import type { RecordingData } from "../recordingData";

const MOST = 600; // pieces of 8 kB

export class Pieces {
  /** Grows with each piece that came. */
  readonly arrived = signal(0);
  private readonly known = new Map<string, Float32Array | null>();

  constructor(
    /** Of the recording that these are the curves of. */
    readonly data: RecordingData,
    readonly list: CurveList,
  ) {}

  /** Pairs of least and greatest values; null while they are on their way. */
  get(curve: number, level: number, number: number): Float32Array | null {
    const key = `${curve} ${level} ${number}`;
    const known = this.known.get(key);
    if (known !== undefined) return known;
    this.known.set(key, null);
    this.data.piece(curve, level, number).then(
      (bytes) => this.came(key, new Float32Array(bytes ?? new ArrayBuffer(0))),
      () => this.known.delete(key), // asked for again when it is looked at again
    );
    return null;
  }

  /** The least and the greatest value of all; null until they are known. */
  bounds(curve: number): [number, number] | null {
    const pairs = this.get(curve, this.list.levels - 1, 0);
    if (!pairs) return null;
    const seen = pairs.filter((value) => !Number.isNaN(value));
    let [low, high] = [Infinity, -Infinity];
    for (const value of seen) [low, high] = [Math.min(low, value), Math.max(high, value)];
    return seen.length ? [low, high] : [0, 1];
  }

  /** The value at a frame; null while it is not known, NaN where nothing was seen. */
  at(curve: number, frame: number): number | null {
    const { piece } = this.list;
    const pairs = this.get(curve, 0, Math.floor(frame / piece));
    return pairs?.length ? (pairs[2 * (frame % piece)] ?? NaN) : null;
  }

  private came(key: string, pairs: Float32Array): void {
    for (const old of this.known.keys()) {
      if (this.known.size <= MOST) break;
      this.known.delete(old);
    }
    this.known.set(key, pairs);
    this.arrived.value += 1;
  }
}
