/** Offer the playback controls. */
import { useStore } from "../store";
import { useThrottled } from "../drawing";
import { toggleFullScreen } from "../util";
import { IconButton, NumberInput, Select, Toggle, type Icon } from "../layout/controls";
import { togglePlay } from "../page";
import { formatTime } from "../view";

const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4];

/** @param curves whether curves are available below the timeline */
export function Transport({ curves = false }: { curves?: boolean }) {
  const store = useStore();
  const { playing, loop, speed } = store;
  const [icon, play] = playing.value ? (["pause", "Pause"] as const) : (["play", "Play"] as const);
  const steps = [
    ["before", "Segment before", "Shift + ←", () => store.stepSegment(-1)],
    ["back", "One frame back", "←", () => store.step(-1)],
    [icon, play, "Space", () => togglePlay(store)],
    ["on", "One frame on", "→", () => store.step(1)],
    ["after", "Segment after", "Shift + →", () => store.stepSegment(1)],
  ] as const;
  const zooms = [
    ["minus", "Zoom out", "−", () => store.zoomBy(1 / 0.7)],
    ["fit", "Show all", "0", () => void (store.zoom.value = null)],
    ["plus", "Zoom in", "+", () => store.zoomBy(0.7)],
  ] as const;
  return (
    <div class="transport" role="toolbar" aria-label="Playing">
      <IconGroup buttons={steps} />
      <IconButton
        icon="loop"
        label="Loop what is marked, else the segment"
        keys="L"
        pressed={loop.value !== null}
        onClick={() => store.toggleLoop()}
      />
      <Select
        label="Speed"
        value={speed.value}
        options={SPEEDS.map((each) => [each, `${each}×`])}
        onSelect={(chosen) => (speed.value = chosen)}
      />
      <Clock />
      {curves && (
        <Toggle class="curves-button" on={store.curves} title="Curves and signals over time (G)">
          Curves
        </Toggle>
      )}
      <IconGroup buttons={zooms} />
      <IconButton icon="full" label="Full screen" keys="F" onClick={toggleFullScreen} />
    </div>
  );
}

function IconGroup(props: {
  buttons: readonly (readonly [icon: Icon, label: string, keys: string, onClick: () => void])[];
}) {
  return (
    <div class="group">
      {props.buttons.map(([icon, label, keys, onClick], i) => (
        <IconButton key={i} {...{ icon, label, keys, onClick }} />
      ))}
    </div>
  );
}

/** Show time and frame, with a slider over the recording. */
function Clock() {
  const store = useStore();
  const { duration } = store;
  const playhead = useThrottled(store.playhead, store.playing);
  const frame = store.getFrameAt(playhead.value);
  return (
    <>
      <output class="clock number">
        <b>{formatTime(playhead.value, 2)}</b>{" "}
        <span class="quiet">/ {formatTime(duration.value, 2)}</span>
      </output>
      <label class="clock-frame quiet">
        frame
        <NumberInput
          aria-label="Frame"
          min={0}
          max={Math.max((store.recording.value?.n_frames ?? 1) - 1, 0)}
          value={frame}
          onNumber={(number) => store.seek(Math.round(number) / store.fps.value)}
        />
      </label>
      <input
        type="range"
        class="scrub"
        aria-label="Playhead"
        aria-valuetext={formatTime(playhead.value, 2)}
        min={0}
        max={duration.value}
        step={0.01}
        value={playhead.value}
        onInput={(event) => store.seek(Number(event.currentTarget.value))}
      />
    </>
  );
}
