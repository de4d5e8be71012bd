/** The repetitions of a cluster over each other, with mean and deviation, as kineme measures them. */
import { useComputed, useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { useStore } from "../context";
import { Canvas } from "../canvas/Canvas";
import { Line } from "../canvas/Line";
import { clusterColor } from "../colors";
import type { ClusterCurves, CycleChannel, CycleCurve } from "../messages";
import type { Store } from "../store";
import { drawCurves, LEFT, nearestCurve, RIGHT } from "./curveDrawing";
import { shownCluster, useClusterCurves } from "./useClusterCurves";

const FARTHEST = 3; // repetitions named that differ most from the mean
const DASHED = " (dashed)";

export function Curves(): JSX.Element {
  const store = useStore();
  const chosen = useSignal("");
  const measured = useClusterCurves(chosen);
  const selected = useComputed(() => cycleAt(store, measured.value?.curves?.cycles ?? []));
  const now = measured.value;
  if (!store.clusters.value.length) return <p class="empty quiet">No cluster to show.</p>;
  if (!now?.curves)
    return (
      <p class="empty quiet" aria-busy={!now}>
        {now ? "No curves of this cluster." : "Measuring …"}
      </p>
    );
  const { channels, curves, opposite } = now;
  const color = clusterColor(shownCluster(store));
  return (
    <div class="curves">
      <div class="curve-choice">
        <span class="swatch" style={{ background: color }} />
        <ChannelSelect
          channels={channels}
          channel={curves.channel}
          choose={(name) => (chosen.value = name)}
        />
        <span class="quiet">{curves.unit}</span>
      </div>
      <div class="curve-room">
        <Canvas
          label={`Curves of ${curves.total} repetitions, with mean and deviation. Click one to go to it.`}
          watch={() => void [measured.value, selected.value, store.cluster.value]}
          draw={(pen, width, height) => {
            const shown = measured.value;
            if (shown?.curves)
              drawCurves(
                pen,
                {
                  curves: shown.curves,
                  opposite: shown.opposite,
                  selected: selected.value,
                  color: clusterColor(shownCluster(store)),
                },
                width,
                height,
              );
          }}
          onClick={(event) => {
            const { left, top, width, height } = event.currentTarget.getBoundingClientRect();
            const [x, y] = [event.clientX - left, event.clientY - top];
            go(store, curves.cycles[nearestCurve(now.curves!, now.opposite, x, y, width, height)]);
          }}
        />
        <Now cycles={curves.cycles} />
      </div>
      <Farthest curves={curves} />
      <p class="quiet note">
        {whatIsShown(curves)}
        {opposite && `; ${opposite.channel}${DASHED}`}
        {curves.turned > 0 &&
          `; ${curves.turned} ${curves.turned === 1 ? "activity" : "activities"} turned to the phase of the others`}
      </p>
    </div>
  );
}

/** How many repetitions the mean is of, and which. */
function whatIsShown({ n, total, ends, cycles }: ClusterCurves): string {
  const mean = "mean ± standard deviation";
  const drawn = cycles.length < total ? `, ${cycles.length} drawn` : "";
  if (!n) return `${total} repetitions${drawn}, none recorded as a whole`;
  if (ends) return `${n} of ${total} repetitions${drawn}, ${mean}`;
  return `${n} inner of ${total} repetitions${drawn}, ${mean}`;
}

interface Choice {
  channels: readonly CycleChannel[];
  channel: string;
  choose: (name: string) => void;
}

function ChannelSelect({ channels, channel, choose }: Choice): JSX.Element {
  const group = channels.find(({ name }) => name === channel)?.group;
  const groups = [...new Set(channels.map((each) => each.group))];
  const names = (of: string | undefined): string[] =>
    channels.filter((each) => each.group === of).map(({ name }) => name);
  return (
    <>
      <select
        aria-label="Channel"
        value={channel}
        onChange={({ currentTarget: { value } }) => choose(value)}
      >
        {names(group).map((name) => (
          <option key={name} value={name}>
            {name}
          </option>
        ))}
      </select>
      <select
        aria-label="What is measured"
        value={group}
        onChange={({ currentTarget: { value } }) => choose(names(value)[0]!)}
      >
        {groups.map((each) => (
          <option key={each} value={each}>
            {each}
          </option>
        ))}
      </select>
    </>
  );
}

/** The repetitions that differ most from the mean, each a way to it. */
function Farthest({ curves: { cycles, unit, n } }: { curves: ClusterCurves }): JSX.Element | null {
  const store = useStore();
  if (n < 3) return null;
  return (
    <p class="farthest" aria-label="Farthest from the mean">
      <span class="quiet">Farthest:</span>
      {cycles.slice(0, FARTHEST).map((each) => {
        const far = `${each.distance?.toPrecision(2)} ${unit}`.trim();
        return (
          <button
            key={each.start_frame}
            type="button"
            title={`${far} from the mean, from ${each.start_s.toFixed(2)} to ${each.stop_s.toFixed(2)} s`}
            onClick={() => go(store, each)}
          >
            {each.start_s.toFixed(1)} s
          </button>
        );
      })}
    </p>
  );
}

/** Selects the segment of a repetition, if it is there still. */
function go(store: Store, cycle: CycleCurve | undefined): void {
  const segment = store.primitives.value.find(
    ({ start_frame }) => start_frame === cycle?.start_frame,
  );
  if (segment) store.select(segment);
}

/** The number of the repetition under the playhead, else of the selected one; -1: neither. */
function cycleAt(store: Store, cycles: readonly CycleCurve[]): number {
  const at = store.playhead.value;
  const present = cycles.findIndex((each) => each.start_s <= at && at < each.stop_s);
  if (present >= 0) return present;
  const selected = store.selected.value;
  return cycles.findIndex((each) => each.start_frame === selected?.start_frame);
}

/** How far the present repetition is; apart from the canvas, so that playing redraws no curves. */
function Now({ cycles }: { cycles: readonly CycleCurve[] }): JSX.Element {
  const store = useStore();
  const at = store.playhead.value;
  const present = cycles.find((each) => each.start_s <= at && at < each.stop_s);
  return (
    <div class="curve-now" style={{ left: `${LEFT}px`, right: `${RIGHT}px` }}>
      {present && <Line share={(at - present.start_s) / (present.stop_s - present.start_s)} />}
    </div>
  );
}
