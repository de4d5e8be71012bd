/** The reference video beside the figure, at the time of the playhead. */
import { useSignalEffect } from "@preact/signals";
import { useRef } from "preact/hooks";
import type { JSX } from "preact";
import { useStudio } from "../context";

const APART = 0.12; // seconds that picture and figure may be apart while they play

export function Video(): JSX.Element | null {
  const { session } = useStudio();
  const recording = session.store.recording.value;
  const video = recording?.video;
  if (!video) return null;
  return <Player key={recording.id} id={recording.id} name={video.name} offset={video.offset_s} />;
}

interface Props {
  id: string;
  name: string;
  offset: number;
}

function Player({ id, name, offset }: Props): JSX.Element {
  const { session } = useStudio();
  const { store, api } = session;
  const element = useRef<HTMLVideoElement>(null);
  const start = useRef(offset);
  const follow = (): void => {
    const shown = element.current;
    if (!shown) return;
    const target = Math.max(store.playhead.value + start.current, 0);
    const playing = store.playing.value;
    if (shown.readyState === 0) return;
    shown.playbackRate = Math.min(Math.max(store.speed.value, 0.0625), 16);
    if (Math.abs(shown.currentTime - target) > (playing ? APART * store.speed.value : 1e-3))
      shown.currentTime = target;
    if (playing && shown.paused && target < shown.duration)
      void shown.play().catch(() => undefined);
    if (!playing && !shown.paused) shown.pause();
  };
  useSignalEffect(follow);
  const place = (seconds: number): void => {
    if (!Number.isFinite(seconds)) return;
    start.current = seconds;
    follow();
    void session.bulletin.attempt("video", () => api.placeVideo(id, { offset_s: seconds }));
  };
  return (
    <figure class="video">
      <video
        ref={element}
        src={api.videoAddress(id)}
        muted
        playsInline
        preload="auto"
        aria-label={`Video ${name}`}
        onLoadedMetadata={follow}
      />
      <figcaption>
        <label title="Seconds of the video at the start of the recording">
          starts at{" "}
          <input
            type="number"
            class="number"
            step="0.02"
            defaultValue={String(offset)}
            onChange={(event) => place(event.currentTarget.valueAsNumber)}
          />{" "}
          s of the video
        </label>
      </figcaption>
    </figure>
  );
}
