/** Overlay the repetitions of a cluster with their mean and standard deviation. */
import { formatCount } from "../formatCount";
import { useComputed, useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { useStore } from "../context";
import { Canvas } from "../canvas/Canvas";
import { PlayheadLine } from "../canvas/PlayheadLine";
import { getClusterColor } from "../colors";
import type { ClusterCurves, CycleChannel, CycleCurve } from "../messages";
import {
  ComparisonSelect,
  getId,
  getOtherRecordings,
  describeComparison,
} from "./ComparisonSelect";
import { findCurrentCycle, findExcluded, selectCycle, summarizeRanges, appendUnit } from "./cycles";
import { CurrentCycle, FarthestCycles, ExcludedCycles } from "./Outliers";
import { drawCurves, MARGIN_LEFT, findNearestCurve, MARGIN_RIGHT } from "./curveDrawing";
import { getShownCluster, useClusterCurves } from "./useClusterCurves";
import { Select, Swatch } from "../layout/controls";

const DASHED = " (dashed)";

export function Curves(): JSX.Element {
  const store = useStore();
  const chosen = useSignal("");
  const besideId = useSignal("");
  const beside = useComputed(() =>
    getOtherRecordings(store).find((each) => getId(each) === besideId.value),
  );
  const measured = useClusterCurves(chosen, beside);
  const cycles = useComputed(() => measured.value?.curves?.cycles ?? []);
  const selected = useComputed(() => findCurrentCycle(store, cycles.value));
  const leftOut = useComputed(() => findExcluded(store, cycles.value));
  const now = measured.value;
  if (!store.clusters.value.length) return <p class="empty quiet">No cluster to show.</p>;
  if (!now?.curves)
    return (
      <p class="empty quiet" aria-busy={!now}>
        {now ? "No curves of this cluster." : "Measuring …"}
      </p>
    );
  const { channels, curves, opposite } = now;
  const color = getClusterColor(getShownCluster(store));
  const ranges = summarizeRanges(
    curves.cycles.filter(({ counts }, i) => counts && !leftOut.value.has(i)),
  );
  return (
    <div class="curves">
      <div class="curve-choice">
        <Swatch color={color} />
        <ChannelSelect
          channels={channels}
          channel={curves.channel}
          onChoose={(name) => (chosen.value = name)}
        />
        <span class="quiet">{curves.unit}</span>
      </div>
      <ComparisonSelect
        others={getOtherRecordings(store)}
        id={beside.value ? besideId.value : ""}
        onChoose={(id) => (besideId.value = id)}
      />
      <div class="curve-room">
        <Canvas
          label={`Curves of ${formatCount(curves.total, "repetition")}, with mean and deviation. Click one to go to it.`}
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
                  color: getClusterColor(getShownCluster(store)),
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
              curves.cycles[findNearestCurve(now.curves!, now.opposite, x, y, width, height)],
            );
          }}
        />
        <CyclePlayhead cycles={curves.cycles} />
      </div>
      <CurrentCycle curves={curves} at={selected.value} leftOut={leftOut.value} />
      <FarthestCycles curves={curves} leftOut={leftOut.value} />
      <ExcludedCycles curves={curves} leftOut={leftOut.value} />
      <p class="quiet note">
        {describeRepetitions(curves)}
        {ranges && `; range ${appendUnit(ranges, curves.unit)}`}
        {beside.value && describeComparison(store, beside.value, curves)}
        {opposite && `; ${opposite.channel}${DASHED}`}
        {curves.turned > 0 &&
          `; ${formatCount(curves.turned, "activity", "activities")} turned to the phase of the others`}
      </p>
    </div>
  );
}

/** Describe how many repetitions the mean includes, and which. */
function describeRepetitions({ n, total, ends, left_out, cycles }: ClusterCurves): string {
  const all = formatCount(total, "repetition");
  const mean = "mean ± standard deviation";
  const drawn = cycles.length < total ? `, ${cycles.length} drawn` : "";
  const without = left_out ? `, ${left_out} left out by hand` : "";
  if (!n && left_out) return `${all}${drawn}${without}, no other recorded as a whole`;
  if (!n) return `${all}${drawn}, none recorded as a whole`;
  if (n === 1)
    return `1${ends ? "" : " inner"} of ${all}${drawn}${without}, bold: too few for a mean`;
  return `${n}${ends ? "" : " inner"} of ${all}${drawn}${without}, ${mean}`;
}

interface ChannelSelectProps {
  channels: readonly CycleChannel[];
  channel: string;
  onChoose: (name: string) => void;
}

function ChannelSelect({ channels, channel, onChoose }: ChannelSelectProps): JSX.Element {
  const group = channels.find(({ name }) => name === channel)?.group ?? "";
  const groups = [...new Set(channels.map((each) => each.group))];
  const listNames = (of: string): string[] =>
    channels.filter((each) => each.group === of).map(({ name }) => name);
  return (
    <>
      <Select
        label="Channel"
        value={channel}
        options={listNames(group).map((name) => [name, name])}
        onSelect={onChoose}
      />
      <Select
        label="What is measured"
        value={group}
        options={groups.map((each) => [each, each])}
        onSelect={(chosen) => onChoose(listNames(chosen)[0]!)}
      />
    </>
  );
}

/** Show the playhead in the current repetition, above the canvas to avoid redrawing it. */
function CyclePlayhead({ cycles }: { cycles: readonly CycleCurve[] }): JSX.Element {
  const store = useStore();
  const at = store.playhead.value;
  const present = cycles.find((each) => each.start_s <= at && at < each.stop_s);
  return (
    <div class="curve-now" style={{ left: `${MARGIN_LEFT}px`, right: `${MARGIN_RIGHT}px` }}>
      {present && (
        <PlayheadLine share={(at - present.start_s) / (present.stop_s - present.start_s)} />
      )}
    </div>
  );
}
