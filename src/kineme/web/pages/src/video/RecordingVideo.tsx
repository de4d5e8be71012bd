/**
 * Show the recording's video with sound and detected keypoints. During playback the page follows
 * the video; otherwise the video shows the frame at the playhead.
 */
import { useSignal, useSignalEffect, type Signal } from "@preact/signals";
import { useEffect, useRef, useState } from "preact/hooks";
import type { JSX } from "preact";
import { NO_COLOR, adaptColor } from "../colors";
import { useStore } from "../context";
import { Button } from "../layout/controls";
import type { OpenRecording } from "../openRecording";
import { findPrimitiveAt } from "../segments";
import type { Store } from "../store";
import { theme } from "../theme";
import { Caption } from "../viewer/Caption";
import { VideoClock } from "./VideoClock";
import { drawKeypoints, fitPicture } from "./keypoints";

interface Props {
  /** Controls below the video; they may change the recording's start in it. */
  children?: (start: Signal<number>) => JSX.Element;
}

export function RecordingVideo({ children }: Props): JSX.Element | null {
  const store = useStore();
  const { value: opened } = store.active;
  if (!opened?.recording.value.video) return null;
  const { file, id } = opened.recording.value;
  return <VideoPlayer key={file || id} opened={opened} {...(children && { children })} />;
}

function VideoPlayer({ opened, children }: Props & { opened: OpenRecording }): JSX.Element {
  const store = useStore();
  const { name, offset_s, picture } = opened.recording.value.video!;
  const element = useRef<HTMLVideoElement>(null);
  const canvas = useRef<HTMLCanvasElement>(null);
  const [addresses] = useState(() => opened.data.getVideoAddresses());
  const shape = useSignal(picture ? picture.width / picture.height : 16 / 9);
  const clock = useRef<VideoClock | null>(null);
  const addressIndex = useSignal(0);
  const start = useSignal(offset_s);
  const isUnplayable = addressIndex.value >= addresses.length;
  useEffect(() => {
    if (isUnplayable || !element.current) return;
    const made = (clock.current = new VideoClock(store, element.current, start));
    const draw = (): void => drawOverlay(store, canvas.current, made);
    const stop = made.start(draw);
    const resize = new ResizeObserver(draw);
    resize.observe(element.current);
    store.videoTime.value = made;
    return () => {
      stop();
      resize.disconnect();
      store.videoTime.value = null;
    };
  }, [store, start, isUnplayable]);
  useSignalEffect(() => {
    for (const each of listPeople(store)) void [each.keypoints.value, each.recording.value];
    void [theme.value, store.videoTime.value];
    if (clock.current) drawOverlay(store, canvas.current, clock.current);
  });

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
        {picture && <canvas ref={canvas} aria-hidden="true" />}
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
          <Button
            aria-pressed={store.figureFirst.value}
            title="The figure large and the video small, or the other way round"
            onClick={() => (store.figureFirst.value = !store.figureFirst.value)}
          >
            Figure large
          </Button>
        )}
      </figcaption>
    </figure>
  );
}

/** Return the people whose keypoints are drawn: all open people of the file. */
function listPeople(store: Store): readonly OpenRecording[] {
  const { people, active } = store;
  if (people.value.length) return people.value;
  return active.value ? [active.value] : [];
}

function drawOverlay(store: Store, canvas: HTMLCanvasElement | null, clock: VideoClock): void {
  const pen = canvas?.getContext("2d");
  const picture = store.recording.peek()?.video?.picture;
  if (!canvas || !pen || !picture) return;
  const { clientWidth: width, clientHeight: height } = canvas;
  [canvas.width, canvas.height] = [width * devicePixelRatio, height * devicePixelRatio];
  pen.scale(devicePixelRatio, devicePixelRatio);
  const seconds = clock.getShownTime();
  for (const each of listPeople(store)) {
    const { value: motion } = each.keypoints;
    const present = findPrimitiveAt(each.recording.value.segmentation, seconds);
    const color = adaptColor((present && store.getColor(present)) ?? NO_COLOR, "dark");
    if (motion) drawKeypoints(pen, fitPicture(picture, width, height), motion, seconds, color);
  }
}
