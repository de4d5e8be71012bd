/** How many pixels the viewer draws: enough for smooth edges, fewer while that is too slow. */

const ENOUGH = 36; // pictures per second: more make no smoother motion that pays for blurred edges
const LEAST = 0.5;
const SMOOTH = 2;
const SETTLE = 24; // pictures between two changes

/** Pixels per CSS pixel, chosen from how long pictures take. */
export class Sharpness {
  /** Share of the full ratio while playing. */
  private share = 1;
  private slow = 0;
  private drawn = 0;

  constructor(private readonly software: boolean) {}

  /** The ratio for a moving picture, or for one that stands still. */
  ratio(screen: number, moving: boolean): number {
    if (!moving) return this.software ? Math.max(screen, 1.5) : SMOOTH;
    return this.share * (this.software ? Math.min(screen, 1) : SMOOTH);
  }

  /** Learns from the seconds that passed since the last moving picture. */
  learn(seconds: number): void {
    this.drawn += 1;
    if (seconds > 1 / ENOUGH) this.slow += 1;
    if (this.drawn < SETTLE) return;
    const late = this.slow / this.drawn > 0.5;
    this.drawn = this.slow = 0;
    if (late) this.share = Math.max(this.share * 0.8, LEAST);
  }
}
