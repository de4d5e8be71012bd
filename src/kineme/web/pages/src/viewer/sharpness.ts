/** Choose the viewer's resolution: high for smooth edges, lower if drawing is too slow. */

const MIN_FRAME_RATE = 36; // frames per second; a higher rate is not worth blurred edges
const MIN_SHARE = 0.5;
const SUPERSAMPLING = 2;
const ADJUST_INTERVAL = 24; // frames between two changes

/** Pixels per CSS pixel, adapted to the duration of frames. */
export class Sharpness {
  /** Share of the full ratio during playback. */
  private share = 1;
  private slow = 0;
  private drawn = 0;

  constructor(private readonly software: boolean) {}

  /** Return the pixel ratio for a moving or a static picture. */
  getRatio(screen: number, moving: boolean): number {
    if (!moving) return this.software ? Math.max(screen, 1.5) : SUPERSAMPLING;
    return this.share * (this.software ? Math.min(screen, 1) : SUPERSAMPLING);
  }

  /** Record the seconds since the last moving frame and lower the resolution if most are slow. */
  recordDuration(seconds: number): void {
    this.drawn += 1;
    if (seconds > 1 / MIN_FRAME_RATE) this.slow += 1;
    if (this.drawn < ADJUST_INTERVAL) return;
    const late = this.slow / this.drawn > 0.5;
    this.drawn = this.slow = 0;
    if (late) this.share = Math.max(this.share * 0.8, MIN_SHARE);
  }
}
