/**
 * Synchronise the page with a video. During playback the video sets the time, so that picture,
 * sound and keypoints match. Outside of the video the page advances by itself.
 */
import { effect, type Signal } from "@preact/signals";
import type { VideoTime } from "../state";
import type { Store } from "../store";

// Seconds between playhead and video; more means that the user moved the playhead.
const MAX_DRIFT = 0.1;
// Seconds added to a frame's time, which may be rounded down to the previous frame.
const FRAME_OFFSET = 0.004;

export class VideoClock implements VideoTime {
  /** Time of the visible picture in the video, seconds; null if the browser does not report it. */
  private shownTime: number | null = null;
  private mayPlay = true;

  constructor(
    private readonly store: Store,
    private readonly video: HTMLVideoElement,
    private readonly offset: Signal<number>,
  ) {}

  /** Return the time of the visible picture in the recording, in seconds. */
  getShownTime(): number {
    return (this.shownTime ?? this.video.currentTime) - this.offset.peek() + 1e-6;
  }

  getTime(): number | "waiting" | null {
    const { video } = this;
    const target = this.store.playhead.peek() + this.offset.peek();
    if (!this.mayPlay || video.error || target < 0 || video.ended || target >= video.duration)
      return null;
    if (video.paused || video.seeking || video.readyState < 3) return "waiting";
    return video.currentTime - this.offset.peek();
  }

  /** Synchronise video and page and call `draw` for each picture; return a function that stops. */
  start(draw: () => void): () => void {
    const { video } = this;
    const syncVideo = (): void => this.syncVideo();
    const stopEffect = effect(syncVideo);
    const events = ["loadedmetadata", "seeked", "canplay"] as const;
    for (const each of events) video.addEventListener(each, syncVideo);
    video.addEventListener("seeked", draw);
    let request = 0;
    const onPicture = (_: number, { mediaTime }: { mediaTime: number }): void => {
      this.shownTime = mediaTime;
      draw();
      request = video.requestVideoFrameCallback(onPicture);
    };
    // Browsers without frame callbacks only report the video's time.
    const tells = typeof HTMLVideoElement.prototype.requestVideoFrameCallback === "function";
    if (tells) request = video.requestVideoFrameCallback(onPicture);
    else video.addEventListener("timeupdate", draw);
    return () => {
      stopEffect();
      if (tells) video.cancelVideoFrameCallback(request);
      for (const each of [...events, "timeupdate"]) video.removeEventListener(each, syncVideo);
      video.removeEventListener("seeked", draw);
      video.removeEventListener("timeupdate", draw);
      video.pause();
    };
  }

  /** Move the video to the playhead. */
  private syncVideo(): void {
    const { video, store } = this;
    const playing = store.playing.value;
    const speed = store.speed.value;
    const target = Math.max(store.playhead.value + this.offset.value, 0);
    if (video.readyState === 0) return;
    video.playbackRate = Math.min(Math.max(speed, 0.0625), 16);
    if (!playing && !video.paused) video.pause();
    // Seeking again before a seek has ended would delay the picture.
    if (!video.seeking) {
      const to = playing ? target : target + FRAME_OFFSET;
      const apart = Math.abs(video.currentTime - Math.min(to, video.duration));
      if (apart > (playing ? MAX_DRIFT * Math.max(speed, 1) : 1e-3)) video.currentTime = to;
    }
    if (playing && video.paused && target < video.duration) void this.play();
  }

  private async play(): Promise<void> {
    const { video, store } = this;
    try {
      await video.play();
    } catch (error) {
      if (!(error instanceof DOMException) || error.name !== "NotAllowedError") return;
      // Browsers only play muted video until the user has clicked the page.
      if (video.muted) this.mayPlay = false;
      else {
        store.muted.value = video.muted = true;
        if (store.playing.peek()) await this.play();
      }
    }
  }
}
