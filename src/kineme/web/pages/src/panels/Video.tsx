/**
 * Show the recording's video with sound and detected keypoints. During playback the page follows
 * the video; otherwise the video shows the frame at the playhead.
 */
import { effect, useSignal, type Signal } from "@preact/signals";
import { useEffect, useRef, useState } from "preact/hooks";
import type { JSX } from "preact";
import { NO_COLOR, adaptColor } from "../colors";
import { useStore, type Store, type VideoTime } from "../store";
import { Button, Toggle } from "../layout/controls";
import type { OpenRecording } from "../recordingData";
import { findPrimitiveAt } from "../segments";
import { Canvas, strokeLine, type Pen } from "../drawing";
import { listen } from "../util";
import { Caption } from "../viewer/Viewer";
import type { Picture } from "../messages";
import { computePose, type Motion } from "../motion";

interface Props {
  /** Controls below the video; they may change the recording's start in it. */
  children?: ((start: Signal<number>) => JSX.Element) | undefined;
}

export function RecordingVideo({ children }: Props) {
  const { value: opened } = useStore().active;
  if (!opened?.recording.value.video) return null;
  const { file, id } = opened.recording.value;
  return (
    <VideoPlayer key={file || id} opened={opened}>
      {children}
    </VideoPlayer>
  );
}

function VideoPlayer({ opened, children }: Props & { opened: OpenRecording }) {
  const store = useStore();
  const { name, offset_s, picture } = opened.recording.value.video!;
  const element = useRef<HTMLVideoElement>(null);
  const [addresses] = useState(() => opened.data.getVideoAddresses());
  const shape = useSignal(picture ? picture.width / picture.height : 16 / 9);
  const clock = useRef<VideoClock | null>(null);
  const drawn = useSignal(0); // pictures of the video so far
  const addressIndex = useSignal(0);
  const start = useSignal(offset_s);
  const isUnplayable = addressIndex.value >= addresses.length;
  useEffect(() => {
    if (isUnplayable || !element.current) return;
    const made = (clock.current = new VideoClock(store, element.current, start));
    const stop = made.start(() => (drawn.value += 1));
    store.videoTime.value = made;
    return () => {
      stop();
      store.videoTime.value = null;
    };
  }, [store, start, drawn, isUnplayable]);

  if (isUnplayable)
    return (
      <p class="no-film quiet">
        {addresses.length > 1
          ? `${name} is not beside this page, or this browser cannot play it.`
          : `This browser cannot play ${name}: convert it to MP4 with H.264 to see it here.`}
      </p>
    );
  const { motion } = opened.recording.value;
  const place = !motion ? "beside" : store.figureFirst.value ? "small" : "large";
  return (
    <figure class={`video ${place}`}>
      <div class="picture" style={{ aspectRatio: place === "large" ? "auto" : `${shape.value}` }}>
        <video
          ref={element}
          src={addresses[addressIndex.value]}
          muted={store.muted.value}
          playsInline
          preload="auto"
          aria-label={`Video ${name}`}
          onLoadedMetadata={({ currentTarget: { videoWidth, videoHeight } }) =>
            (shape.value = videoWidth / (videoHeight || 1))
          }
          onError={() => (addressIndex.value += 1)}
        />
        {picture && (
          <Canvas
            label="Keypoints"
            aria-hidden="true"
            watch={() => {
              for (const each of listPeople(store))
                void [each.keypoints.value, each.recording.value];
              void [drawn.value, store.videoTime.value];
            }}
            draw={(pen) => clock.current && drawOverlay(pen, store, picture, clock.current)}
          />
        )}
      </div>
      {place === "large" && <Caption />}
      <figcaption>
        {children?.(start)}
        <Button
          aria-pressed={!store.muted.value}
          title="The sound of the video"
          onClick={() => (store.muted.value = !store.muted.value)}
        >
          Sound
        </Button>
        {motion && (
          <Toggle
            on={store.figureFirst}
            title="The figure large and the video small, or the other way round"
          >
            Figure large
          </Toggle>
        )}
      </figcaption>
    </figure>
  );
}

/** Return the people whose keypoints are drawn: all open people of the file. */
function listPeople({ people, active }: Store): readonly OpenRecording[] {
  if (people.value.length) return people.value;
  return active.value ? [active.value] : [];
}

function drawOverlay(pen: Pen, store: Store, picture: Picture, clock: VideoClock): void {
  const { clientWidth: width, clientHeight: height } = pen.canvas;
  const seconds = clock.getShownTime();
  for (const each of listPeople(store)) {
    const { value: motion } = each.keypoints;
    const present = findPrimitiveAt(each.recording.value.segmentation, seconds);
    const color = adaptColor((present && store.getColor(present)) ?? NO_COLOR, "dark");
    if (motion) drawKeypoints(pen, fitPicture(picture, width, height), motion, seconds, color);
  }
}

// Seconds between playhead and video; more means that the user moved the playhead.
const MAX_DRIFT = 0.1;
// Seconds added to a frame's time, which may be rounded down to the previous frame.
const FRAME_OFFSET = 0.004;

/**
 * Synchronise the page with a video. During playback the video sets the time, so that picture,
 * sound and keypoints match. Outside of the video the page advances by itself.
 */
class VideoClock implements VideoTime {
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
    const stops = [
      effect(syncVideo),
      listen(video, { loadedmetadata: syncVideo, seeked: syncVideo, canplay: syncVideo }),
      listen(video, { seeked: draw }),
    ];
    let request = 0;
    const onPicture = (_: number, { mediaTime }: { mediaTime: number }): void => {
      this.shownTime = mediaTime;
      draw();
      request = video.requestVideoFrameCallback(onPicture);
    };
    // Browsers without frame callbacks only report the video's time.
    const tells = typeof HTMLVideoElement.prototype.requestVideoFrameCallback === "function";
    if (tells) request = video.requestVideoFrameCallback(onPicture);
    else stops.push(listen(video, { timeupdate: draw }));
    return () => {
      for (const stop of stops) stop();
      if (tells) video.cancelVideoFrameCallback(request);
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

/** Position of a picture that is scaled to fit a box, and box pixels per picture pixel. */
type PictureFit = Record<"left" | "top" | "scale", number>;

export function fitPicture(
  picture: Pick<Picture, "width" | "height">,
  width: number,
  height: number,
): PictureFit {
  const scale = Math.min(width / picture.width, height / picture.height);
  const left = (width - scale * picture.width) / 2;
  return { left, top: (height - scale * picture.height) / 2, scale };
}

const MIN_CERTAINTY = 50; // percent; keypoints below are drawn faintly
const FAINT_ALPHA = 0.35;

/** Draw the keypoints of the frame nearest to a time (seconds of the recording). */
function drawKeypoints(
  pen: Pen,
  { left, top, scale }: PictureFit,
  motion: Motion,
  seconds: number,
  color: string,
): void {
  const { joints, bones, sample_fps, n_samples } = motion.head;
  const frame = Math.round(seconds * sample_fps);
  if (frame < 0 || frame >= n_samples) return;
  const pose = new Float32Array(3 * joints.length);
  computePose(motion, frame / sample_fps, pose);
  const at = (i: number): [number, number] => [
    left + scale * pose[3 * i]!,
    top + scale * pose[3 * i + 1]!,
  ];
  const chooseAlpha = (...points: number[]): number =>
    Math.min(...points.map((i) => pose[3 * i + 2]!)) < MIN_CERTAINTY ? FAINT_ALPHA : 1;
  const drawn = new Set(bones.flat().filter((i) => !Number.isNaN(pose[3 * i]!)));
  pen.lineCap = "round";
  // A dark outline makes the coloured line visible on any picture.
  for (const [width, style] of [
    [6, "rgb(0 0 0 / 55%)"],
    [3.5, color],
  ] as const) {
    pen.lineWidth = width;
    pen.strokeStyle = pen.fillStyle = style;
    for (const [a, b] of bones) {
      if (!drawn.has(a) || !drawn.has(b)) continue;
      pen.globalAlpha = chooseAlpha(a, b);
      strokeLine(pen, [at(a), at(b)]);
    }
    for (const i of drawn) {
      pen.globalAlpha = chooseAlpha(i);
      pen.beginPath();
      pen.arc(...at(i), width * 0.75, 0, 2 * Math.PI);
      pen.fill();
    }
  }
  pen.globalAlpha = 1;
}
