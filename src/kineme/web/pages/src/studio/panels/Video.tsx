/** The video of the recording, and where in it the recording starts. */
import type { Signal } from "@preact/signals";
import type { JSX } from "preact";
import { Film } from "../../film/Film";
import { useStudio } from "../context";

export function Video(): JSX.Element {
  return <Film>{(start) => <Start start={start} />}</Film>;
}

function Start({ start }: { start: Signal<number> }): JSX.Element | null {
  const { session } = useStudio();
  const { store, api } = session;
  if (store.recording.value?.video?.picture) return null; // the poses come from it
  const place = (seconds: number): void => {
    const { value: recording } = store.recording;
    if (!recording || !Number.isFinite(seconds)) return;
    start.value = seconds;
    const request = { offset_s: seconds };
    void session.bulletin.attempt("video", () => api.placeVideo(recording.id, request));
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
