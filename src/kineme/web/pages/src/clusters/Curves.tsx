/** The repetitions of a cluster over each other, with mean and deviation, as kineme measures them. */
import { counted } from "../counted";
import { useComputed, useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { useStore } from "../context";
import { Canvas } from "../canvas/Canvas";
import { Line } from "../canvas/Line";
import { clusterColor } from "../colors";
import type { ClusterCurves, CycleChannel, CycleCurve } from "../messages";
import { BesideSelect, idOf, othersOf, whatIsBeside } from "./Beside";
import { cycleAt, leftOutOf, selectCycle, summarizeRanges, withUnit } from "./cycles";
import { Chosen, Farthest, LeftOut } from "./Outliers";
import { drawCurves, LEFT, nearestCurve, RIGHT } from "./curveDrawing";
import { shownCluster, useClusterCurves } from "./useClusterCurves";
import { Select } from "../layout/controls";

const DASHED = " (dashed)";

export function Curves(): JSX.Element {
  const store = useStore();
  const chosen = useSignal("");
  const besideId = useSignal("");
  const beside = useComputed(() => othersOf(store).find((each) => idOf(each) === besideId.value));
  const measured = useClusterCurves(chosen, beside);
  const cycles = useComputed(() => measured.value?.curves?.cycles ?? []);
  const selected = useComputed(() => cycleAt(store, cycles.value));
  const leftOut = useComputed(() => leftOutOf(store, cycles.value));
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
  const ranges = summarizeRanges(
    curves.cycles.filter(({ counts }, i) => counts && !leftOut.value.has(i)),
  );
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
      <BesideSelect
        others={othersOf(store)}
        id={beside.value ? besideId.value : ""}
        choose={(id) => (besideId.value = id)}
      />
      <div class="curve-room">
        <Canvas
          label={`Curves of ${counted(curves.total, "repetition")}, with mean and deviation. Click one to go to it.`}
          watch={() => void [measured.value, selected.value, leftOut.value, store.cluster.value]}
          draw={(pen, width, height) => {
            const shown = measured.value;
            if (shown?.curves)
              drawCurves(
                pen,
                {
                  curves: shown.curves,
                  opposite: shown.opposite,
                  leftOut: leftOut.value,
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
            selectCycle(
              store,
              curves.cycles[nearestCurve(now.curves!, now.opposite, x, y, width, height)],
            );
          }}
        />
        <Now cycles={curves.cycles} />
      </div>
      <Chosen curves={curves} at={selected.value} leftOut={leftOut.value} />
      <Farthest curves={curves} leftOut={leftOut.value} />
      <LeftOut curves={curves} leftOut={leftOut.value} />
      <p class="quiet note">
        {whatIsShown(curves)}
        {ranges && `; range ${withUnit(ranges, curves.unit)}`}
        {beside.value && whatIsBeside(store, beside.value, curves)}
        {opposite && `; ${opposite.channel}${DASHED}`}
        {curves.turned > 0 &&
          `; ${counted(curves.turned, "activity", "activities")} turned to the phase of the others`}
      </p>
    </div>
  );
}

/** How many repetitions the mean is of, and which. */
function whatIsShown({ n, total, ends, left_out, cycles }: ClusterCurves): string {
  const all = counted(total, "repetition");
  const mean = "mean ± standard deviation";
  const drawn = cycles.length < total ? `, ${cycles.length} drawn` : "";
  const without = left_out ? `, ${left_out} left out by hand` : "";
  if (!n && left_out) return `${all}${drawn}${without}, no other recorded as a whole`;
  if (!n) return `${all}${drawn}, none recorded as a whole`;
  if (n === 1)
    return `1${ends ? "" : " inner"} of ${all}${drawn}${without}, bold: too few for a mean`;
  return `${n}${ends ? "" : " inner"} of ${all}${drawn}${without}, ${mean}`;
}

interface Choice {
  channels: readonly CycleChannel[];
  channel: string;
  choose: (name: string) => void;
}

function ChannelSelect({ channels, channel, choose }: Choice): JSX.Element {
  const group = channels.find(({ name }) => name === channel)?.group ?? "";
  const groups = [...new Set(channels.map((each) => each.group))];
  const names = (of: string): string[] =>
    channels.filter((each) => each.group === of).map(({ name }) => name);
  return (
    <>
      <Select
        label="Channel"
        value={channel}
        options={names(group).map((name) => [name, name])}
        onSelect={choose}
      />
      <Select
        label="What is measured"
        value={group}
        options={groups.map((each) => [each, each])}
        onSelect={(chosen) => choose(names(chosen)[0]!)}
      />
    </>
  );
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
