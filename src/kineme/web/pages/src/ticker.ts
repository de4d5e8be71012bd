/** Run all drawing in one loop, at most once per screen refresh. */
import { effect } from "@preact/signals";

/** Called before each frame with the seconds since the last one (at most 0.5). */
type Task = (seconds: number) => void;

class Ticker {
  /** Number of frames drawn. */
  drawn = 0;
  private readonly tasks = new Set<Task>();
  private readonly times: number[] = [];
  private pending = 0;
  private last = 0;

  add(task: Task): () => void {
    this.tasks.add(task);
    this.request();
    return () => this.tasks.delete(task);
  }

  /** Request another frame. */
  request(): void {
    if (this.pending === 0) this.pending = requestAnimationFrame((now) => this.run(now));
  }

  /** Draw immediately. */
  drawNow(): void {
    cancelAnimationFrame(this.pending);
    this.run(performance.now());
  }

  /** Return the number of frames within the last second. */
  measureRate(now: number = performance.now()): number {
    return this.times.filter((time) => now - time <= 1000).length;
  }

  private run(now: number): void {
    this.pending = 0;
    const seconds = Math.min(Math.max((now - this.last) / 1000, 0), 0.5);
    this.last = now;
    this.times.push(now);
    if (this.times.length > 240) this.times.splice(0, 120);
    this.drawn += 1;
    for (const task of this.tasks) task(seconds);
  }
}

export const ticker = new Ticker();

/** Draw when a signal read by `watch` changes; return a function that stops. */
export function drawOnChange(watch: () => void, draw: Task): () => void {
  let dirty = true;
  const stopDrawing = ticker.add((seconds) => {
    if (!dirty) return;
    dirty = false;
    draw(seconds);
  });
  const stopWatching = effect(() => {
    watch();
    dirty = true;
    ticker.request();
  });
  return () => {
    stopWatching();
    stopDrawing();
  };
}
