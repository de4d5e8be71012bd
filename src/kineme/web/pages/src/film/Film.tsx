/**
 * The video of a recording, large, with sound and the keypoints that were found in it. While it
 * plays, the page follows it; while the page rests, it shows the frame of the playhead.
 */
import { useSignal, useSignalEffect, type Signal } from "@preact/signals";
import { useEffect, useRef, useState } from "preact/hooks";
import type { JSX } from "preact";
import { NO_COLOR, onPage } from "../colors";
import { useStore } from "../context";
import { Button } from "../layout/controls";
import type { OpenRecording } from "../opened";
import { primitiveAt } from "../segments";
import type { Store } from "../store";
import { theme } from "../theme";
import { Caption } from "../viewer/Caption";
import { FilmClock } from "./clock";
import { drawKeypoints, fitted } from "./picture";

interface Props {
  /** What stands below the picture; it may move the start of the recording in the video. */
  children?: (start: Signal<number>) => JSX.Element;
}

export function Film({ children }: Props): JSX.Element | null {
  const store = useStore();
  const { value: opened } = store.active;
  if (!opened?.recording.value.video) return null;
  const { file, id } = opened.recording.value;
  return <Player key={file || id} opened={opened} {...(children && { children })} />;
}

function Player({ opened, children }: Props & { opened: OpenRecording }): JSX.Element {
  const store = useStore();
  const { name, offset_s, picture } = opened.recording.value.video!;
  const element = useRef<HTMLVideoElement>(null);
  const canvas = useRef<HTMLCanvasElement>(null);
  const [addresses] = useState(() => opened.data.videoAddresses());
  const shape = useSignal(picture ? picture.width / picture.height : 16 / 9);
  const clock = useRef<FilmClock | null>(null);
  const tried = useSignal(0);
  const start = useSignal(offset_s);
  const isLost = tried.value >= addresses.length;
  useEffect(() => {
    if (isLost || !element.current) return;
    const made = (clock.current = new FilmClock(store, element.current, start));
    const draw = (): void => paint(store, canvas.current, made);
    const stop = made.run(draw);
    const resize = new ResizeObserver(draw);
    resize.observe(element.current);
    store.film.value = made;
    return () => {
      stop();
      resize.disconnect();
      store.film.value = null;
    };
  }, [store, start, isLost]);
  useSignalEffect(() => {
    for (const each of peopleIn(store)) void [each.keypoints.value, each.recording.value];
    void [theme.value, store.film.value];
    if (clock.current) paint(store, canvas.current, clock.current);
  });

  if (isLost)
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
          src={addresses[tried.value]}
          muted={store.muted.value}
          playsInline
          preload="auto"
          aria-label={`Video ${name}`}
          onLoadedMetadata={({ currentTarget: { videoWidth, videoHeight } }) =>
            (shape.value = videoWidth / (videoHeight || 1))
          }
          onError={() => (tried.value += 1)}
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

/** Whose keypoints are drawn: all people of the file who are open. */
function peopleIn(store: Store): readonly OpenRecording[] {
  const { people, active } = store;
  if (people.value.length) return people.value;
  return active.value ? [active.value] : [];
}

function paint(store: Store, canvas: HTMLCanvasElement | null, clock: FilmClock): void {
  const pen = canvas?.getContext("2d");
  const picture = store.recording.peek()?.video?.picture;
  if (!canvas || !pen || !picture) return;
  const { clientWidth: width, clientHeight: height } = canvas;
  [canvas.width, canvas.height] = [width * devicePixelRatio, height * devicePixelRatio];
  pen.scale(devicePixelRatio, devicePixelRatio);
  const seconds = clock.shown();
  for (const each of peopleIn(store)) {
    const { value: motion } = each.keypoints;
    const present = primitiveAt(each.recording.value.segmentation, seconds);
    const color = onPage((present && store.colorOf(present)) ?? NO_COLOR, "dark");
    if (motion) drawKeypoints(pen, fitted(picture, width, height), motion, seconds, color);
  }
}
