/** Show the recording's video, with a field for its offset. */
import type { Signal } from "@preact/signals";
import type { JSX } from "preact";
import { RecordingVideo } from "../../video/RecordingVideo";
import { useStudio } from "../context";

export function StudioVideo(): JSX.Element {
  return <RecordingVideo>{(start) => <VideoOffset start={start} />}</RecordingVideo>;
}

function VideoOffset({ start }: { start: Signal<number> }): JSX.Element | null {
  const { session } = useStudio();
  const { store, api } = session;
  // The poses come from it, so the offset is known.
  if (store.recording.value?.video?.picture) return null;
  const place = (seconds: number): void => {
    const { value: recording } = store.recording;
    if (!recording || !Number.isFinite(seconds)) return;
    start.value = seconds;
    const request = { offset_s: seconds };
    void session.notifications.attempt("video", () => api.placeVideo(recording.id, request));
  };
  return (
    <label title="Seconds of the video at the start of the recording">
      starts at{" "}
      <input
        type="number"
        class="number"
        step="0.02"
        defaultValue={String(+start.peek().toFixed(3))}
        onChange={(event) => place(event.currentTarget.valueAsNumber)}
      />{" "}
      s of the video
    </label>
  );
}
