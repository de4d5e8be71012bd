/** One clock for everything that is drawn: at most one picture per refresh of the screen. */
import { effect } from "@preact/signals";

/** Called before each picture with the seconds since the last one (at most 0.5). */
export type Task = (seconds: number) => void;

export class Ticker {
  /** Pictures drawn since the page was opened. */
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

  /** Asks for one more picture. */
  request(): void {
    if (this.pending === 0) this.pending = requestAnimationFrame((now) => this.run(now));
  }

  /** Draws without waiting for the screen. */
  drawNow(): void {
    cancelAnimationFrame(this.pending);
    this.run(performance.now());
  }

  /** Pictures drawn within the last second. */
  rate(now: number = performance.now()): number {
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

/**
 * Draws before the next picture whenever a signal that `watch` reads has changed.
 * Call the result to stop it.
 */
export function painter(watch: () => void, draw: Task): () => void {
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
