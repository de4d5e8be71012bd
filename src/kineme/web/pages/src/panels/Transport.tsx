/** Offer the playback controls. */
import { useStore } from "../store";
import { useThrottled } from "../drawing";
import { toggleFullScreen } from "../util";
import { IconButton, NumberInput, Select, Toggle } from "../layout/controls";
import { togglePlay } from "../page";
import { formatTime } from "../view";

const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4];

/** @param curves whether curves are available below the timeline */
export function Transport({ curves = false }: { curves?: boolean }) {
  const store = useStore();
  const { playing, loop, speed } = store;
  return (
    <div class="transport" role="toolbar" aria-label="Playing">
      <div class="group">
        <IconButton
          icon="before"
          label="Segment before"
          keys="Shift + ←"
          onClick={() => store.stepSegment(-1)}
        />
        <IconButton icon="back" label="One frame back" keys="←" onClick={() => store.step(-1)} />
        <IconButton
          icon={playing.value ? "pause" : "play"}
          label={playing.value ? "Pause" : "Play"}
          keys="Space"
          onClick={() => togglePlay(store)}
        />
        <IconButton icon="on" label="One frame on" keys="→" onClick={() => store.step(1)} />
        <IconButton
          icon="after"
          label="Segment after"
          keys="Shift + →"
          onClick={() => store.stepSegment(1)}
        />
      </div>
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
      <div class="group">
        <IconButton icon="minus" label="Zoom out" keys="−" onClick={() => store.zoomBy(1 / 0.7)} />
        <IconButton
          icon="fit"
          label="Show all"
          keys="0"
          onClick={() => (store.zoom.value = null)}
        />
        <IconButton icon="plus" label="Zoom in" keys="+" onClick={() => store.zoomBy(0.7)} />
      </div>
      <IconButton icon="full" label="Full screen" keys="F" onClick={toggleFullScreen} />
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
