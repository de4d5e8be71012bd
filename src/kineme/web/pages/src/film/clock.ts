/**
 * Time in a video. While the page plays, the video sets the pace, so that picture, sound and
 * keypoints are never apart; where it has no picture for the time, the page goes on by itself.
 */
import { effect, type Signal } from "@preact/signals";
import type { Pace } from "../state";
import type { Store } from "../store";

const APART = 0.1; // seconds from the playhead to the video that nobody but a person makes
const INSIDE = 0.004; // seconds into a frame: its time may be rounded to the one before

export class FilmClock implements Pace {
  /** Second of the video whose picture is seen, where the browser tells. */
  private seen: number | null = null;
  private mayPlay = true;

  constructor(
    private readonly store: Store,
    private readonly video: HTMLVideoElement,
    private readonly start: Signal<number>,
  ) {}

  /** Second of the recording whose picture is seen. */
  shown(): number {
    return (this.seen ?? this.video.currentTime) - this.start.peek() + 1e-6;
  }

  seconds(): number | "waits" | null {
    const { video } = this;
    const target = this.store.playhead.peek() + this.start.peek();
    if (!this.mayPlay || video.error || target < 0 || video.ended || target >= video.duration)
      return null;
    if (video.paused || video.seeking || video.readyState < 3) return "waits";
    return video.currentTime - this.start.peek();
  }

  /** Keeps video and page together; `draw` is called for each picture. Call the result to stop. */
  run(draw: () => void): () => void {
    const { video } = this;
    const follow = (): void => this.follow();
    const stopEffect = effect(follow);
    const events = ["loadedmetadata", "seeked", "canplay"] as const;
    for (const each of events) video.addEventListener(each, follow);
    video.addEventListener("seeked", draw);
    let request = 0;
    const onPicture = (_: number, { mediaTime }: { mediaTime: number }): void => {
      this.seen = mediaTime;
      draw();
      request = video.requestVideoFrameCallback(onPicture);
    };
    // Where a browser cannot tell its pictures, the time of the video has to do.
    const tells = typeof HTMLVideoElement.prototype.requestVideoFrameCallback === "function";
    if (tells) request = video.requestVideoFrameCallback(onPicture);
    else video.addEventListener("timeupdate", draw);
    return () => {
      stopEffect();
      if (tells) video.cancelVideoFrameCallback(request);
      for (const each of [...events, "timeupdate"]) video.removeEventListener(each, follow);
      video.removeEventListener("seeked", draw);
      video.removeEventListener("timeupdate", draw);
      video.pause();
    };
  }

  /** Brings the video to where the playhead is, playing or at rest. */
  private follow(): void {
    const { video, store } = this;
    const playing = store.playing.value;
    const speed = store.speed.value;
    const target = Math.max(store.playhead.value + this.start.value, 0);
    if (video.readyState === 0) return;
    video.playbackRate = Math.min(Math.max(speed, 0.0625), 16);
    if (!playing && !video.paused) video.pause();
    // A seek that is under way is waited for: each new one would put off the picture.
    if (!video.seeking) {
      const to = playing ? target : target + INSIDE;
      const apart = Math.abs(video.currentTime - Math.min(to, video.duration));
      if (apart > (playing ? APART * Math.max(speed, 1) : 1e-3)) video.currentTime = to;
    }
    if (playing && video.paused && target < video.duration) void this.play();
  }

  private async play(): Promise<void> {
    const { video, store } = this;
    try {
      await video.play();
    } catch (error) {
      if (!(error instanceof DOMException) || error.name !== "NotAllowedError") return;
      // A page that nobody has clicked yet may play without sound only.
      if (video.muted) this.mayPlay = false;
      else {
        store.muted.value = video.muted = true;
        if (store.playing.peek()) await this.play();
      }
    }
  }
}
