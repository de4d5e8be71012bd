/** Load a recording's curves in tiles on demand and cache the latest. */
import { signal, useComputed, useSignal, type ReadonlySignal } from "@preact/signals";
import type { CurveList } from "../messages";
import type { RecordingData } from "../recordingData";
import { useEffect } from "preact/hooks";
import { useStore } from "../store";

const MAX_TILES = 2000; // of 8 kB each

export class CurveTiles {
  /** Number of loaded tiles; redraws depend on it. */
  readonly loadCount = signal(0);
  private readonly cache = new Map<string, Float32Array | null>();

  constructor(
    readonly data: RecordingData,
    readonly list: CurveList,
  ) {}

  /** Return pairs of minimum and maximum; null while loading. */
  get(curve: number, level: number, number: number): Float32Array | null {
    const key = `${curve} ${level} ${number}`;
    const recent = this.cache.get(key);
    if (recent !== undefined) return recent;
    this.cache.set(key, null);
    void this.data.loadCurveTile(curve, level, number).then(
      (bytes) => this.storeTile(key, new Float32Array(bytes ?? new ArrayBuffer(0))),
      () => this.cache.delete(key), // the next draw requests it again
    );
    return null;
  }

  /** Return the curve's minimum and maximum; null while loading. */
  getBounds(curve: number): [number, number] | null {
    const pairs = this.get(curve, this.list.levels - 1, 0);
    if (!pairs) return null;
    const finite = pairs.filter((value) => !Number.isNaN(value));
    let [low, high] = [Infinity, -Infinity];
    for (const value of finite) [low, high] = [Math.min(low, value), Math.max(high, value)];
    return finite.length ? [low, high] : [0, 1];
  }

  /** Return the value at a frame; null while loading, NaN if missing. */
  getValue(curve: number, frame: number): number | null {
    const { tile } = this.list;
    const pairs = this.get(curve, 0, Math.floor(frame / tile));
    return pairs?.length ? (pairs[2 * (frame % tile)] ?? NaN) : null;
  }

  private storeTile(key: string, pairs: Float32Array): void {
    for (const old of this.cache.keys()) {
      if (this.cache.size <= MAX_TILES) break;
      this.cache.delete(old);
    }
    this.cache.set(key, pairs);
    this.loadCount.value += 1;
  }
}

/** Return the curve tiles of the active recording; null while loading. */
export function useCurveTiles(): ReadonlySignal<CurveTiles | null> {
  const store = useStore();
  const data = store.active.value?.data;
  const loaded = useSignal<CurveTiles | null>(null);
  useEffect(() => {
    let isCurrent = true;
    void data?.loadCurves().then(
      (list) => {
        if (isCurrent && list) loaded.value = new CurveTiles(data, list);
      },
      () => undefined,
    );
    return () => void (isCurrent = false);
  }, [data, loaded]);
  return useComputed(() => (loaded.value?.data === store.active.value?.data ? loaded.value : null));
}
