/** Overlay the repetitions of a cluster with their mean and standard deviation. */
import { computeMean, formatCount } from "../util";
import { useComputed, useSignal, useSignalEffect, type ReadonlySignal } from "@preact/signals";
import { useStore, type Store } from "../store";
import { Canvas, PlayheadLine } from "../drawing";
import { getClusterColor } from "../colors";
import type { ClusterCurves, CycleChannel, CycleCurve } from "../messages";
import { MARGIN_LEFT, MARGIN_RIGHT, drawCurves, findNearestCurve } from "./curveDrawing";
import { Button, Select, Swatch } from "../layout/controls";
import type { OpenRecording, RecordingData } from "../recordingData";

export function Curves() {
  const store = useStore();
  const chosen = useSignal("");
  const besideId = useSignal("");
  const others = useComputed(() =>
    store.opened.value.filter((each) => each !== store.active.value),
  );
  const beside = useComputed(() =>
    others.value.find(({ recording }) => recording.value.id === besideId.value),
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
  const counted = curves.cycles.filter(({ counts }, i) => counts && !leftOut.value.has(i));
  const ranges = summarizeRanges(counted);
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
      {others.value.length > 0 && (
        <div class="curve-choice">
          <span class="quiet">Beside</span>
          <Select
            label="Beside"
            value={beside.value ? besideId.value : ""}
            options={[
              ["", "no other recording"],
              ...others.value.map(
                ({ recording }) => [recording.value.id, recording.value.name] as const,
              ),
            ]}
            onSelect={(id) => (besideId.value = id)}
          />
        </div>
      )}
      <div class="curve-room">
        <Canvas
          label={`Curves of ${formatCount(curves.total, "repetition")}, with mean and deviation. Click one to go to it.`}
          watch={() => void [measured.value, selected.value, leftOut.value, store.cluster.value]}
          draw={(pen, ...size) => {
            const { curves, opposite } = measured.value ?? {};
            const color = getClusterColor(getShownCluster(store));
            const marks = { leftOut: leftOut.value, selected: selected.value, color };
            if (curves) drawCurves(pen, { curves, opposite: opposite ?? null, ...marks }, ...size);
          }}
          onClick={(event) => {
            const { left, top, width, height } = event.currentTarget.getBoundingClientRect();
            const [x, y] = [event.clientX - left, event.clientY - top];
            const nearest = findNearestCurve(curves, opposite, x, y, width, height);
            selectCycle(store, curves.cycles[nearest]);
          }}
        />
        <CyclePlayhead cycles={curves.cycles} />
      </div>
      <CurrentCycle
        cycle={curves.cycles[selected.value]}
        unit={curves.unit}
        isOut={leftOut.value.has(selected.value)}
      />
      <CycleList
        title="Farthest"
        label="Farthest from the mean"
        cycles={curves.n < 3 ? [] : counted.slice(0, MAX_FARTHEST)}
        unit={curves.unit}
      />
      <CycleList
        title="Left out"
        label="Left out by hand"
        cycles={curves.cycles.filter((_, i) => leftOut.value.has(i))}
        isOut
      />
      <p class="quiet note">
        {describeRepetitions(curves)}
        {ranges && `; range ${appendUnit(ranges, curves.unit)}`}
        {beside.value && describeComparison(store, beside.value, curves)}
        {opposite && `; ${opposite.channel} (dashed)`}
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

function ChannelSelect(props: {
  channels: readonly CycleChannel[];
  channel: string;
  onChoose: (name: string) => void;
}) {
  const { channels, channel, onChoose } = props;
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
function CyclePlayhead({ cycles }: { cycles: readonly CycleCurve[] }) {
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

/** Describe the other recording's curve, or why it has none. */
function describeComparison(
  store: Store,
  other: OpenRecording,
  { beside, channel }: ClusterCurves,
): string {
  const { name } = other.recording.value;
  if (beside)
    return `; ${name} (dashed): ${beside.n} of ${beside.total}; a bar where they differ (95 %)`;
  const { label } = store.shownCluster.value ?? store.clusters.value[0] ?? {};
  if (!label) return `; name this movement alike in both to see that of ${name}`;
  return `; ${name} has no “${label}”, or no ${channel}`;
}

const MAX_FARTHEST = 3;

/** Show the repetition at the playhead and its distance from the mean. */
function CurrentCycle(props: { cycle: CycleCurve | undefined; unit: string; isOut: boolean }) {
  const { cycle, unit, isOut } = props;
  const store = useStore();
  if (!cycle) return <p class="chosen quiet">None of them at the playhead.</p>;
  const range = computeRange(cycle);
  const key = store.selected.value?.start_frame === cycle.start_frame ? " (X)" : "";
  const edit = store.edit.value;
  return (
    <p class="chosen" aria-label="At the playhead">
      <span class="number">{cycle.start_s.toFixed(2)} s</span>
      {range !== null && <span class="quiet">range {appendUnit(formatNumber(range), unit)}</span>}
      <span class="quiet">{isOut ? "left out by hand" : describeDeviation(cycle, unit)}</span>
      <span class="spacer" />
      {edit && (
        <Button
          title={(isOut ? "Count it in the mean again" : "Leave it out of the mean") + key}
          onClick={() => edit({ kind: "exclude", frames: [cycle.start_frame], excluded: !isOut })}
        >
          {isOut ? "Bring back" : "Leave out"}
        </Button>
      )}
    </p>
  );
}

/** List repetitions, with buttons to exclude them or, if they are, to include them again. */
function CycleList(props: {
  title: string;
  label: string;
  cycles: readonly CycleCurve[];
  unit?: string;
  isOut?: boolean;
}) {
  const { title, label, cycles, unit = "", isOut = false } = props;
  const store = useStore();
  const edit = store.edit.value;
  const what = isOut ? "Bring back into the mean" : "Leave out of the mean";
  if (!cycles.length) return null;
  return (
    <p class={isOut ? "farthest left-out" : "farthest"} aria-label={label}>
      <span class="quiet">{title}:</span>
      {cycles.map((cycle) => {
        const { start_frame, start_s, stop_s } = cycle;
        const deviation = isOut ? "left out by hand" : describeDeviation(cycle, unit);
        return (
          <span class="chip" key={start_frame}>
            <Button
              title={`${deviation}, from ${start_s.toFixed(2)} to ${stop_s.toFixed(2)} s`}
              onClick={() => selectCycle(store, cycle)}
            >
              {start_s.toFixed(1)} s
            </Button>
            {edit && (
              <Button
                title={what}
                aria-label={`${what}: ${start_s.toFixed(1)} s`}
                onClick={({ detail }) => {
                  // Ignore double clicks: the next chip moves under the pointer.
                  if (detail < 2)
                    edit({ kind: "exclude", frames: [start_frame], excluded: !isOut });
                }}
              >
                {isOut ? "↺" : "×"}
              </Button>
            )}
          </span>
        );
      })}
    </p>
  );
}

/** Describe a repetition's distance from the mean and why it is not included. */
function describeDeviation({ distance, note }: CycleCurve, unit: string): string {
  const number = distance?.toPrecision(2);
  const far = number === undefined ? "" : appendUnit(number, unit);
  return [far && `${far} from the mean`, note].filter(Boolean).join(", ");
}

/** Select a repetition's segment and go to the repetition's start. */
function selectCycle(store: Store, cycle: CycleCurve | undefined): void {
  const segment = store.primitives.value.find(
    ({ start_frame }) => start_frame === cycle?.start_frame,
  );
  if (!segment || !cycle) return;
  store.select(segment);
  if (segment.start_s < cycle.start_s && cycle.start_s < segment.stop_s) store.seek(cycle.start_s);
}

/** Return the indices of the repetitions that the table excludes. */
function findExcluded(store: Store, cycles: readonly CycleCurve[]): ReadonlySet<number> {
  const rows = store.primitives.value.filter(({ excluded }) => excluded);
  const starts = new Set(rows.map(({ start_frame }) => start_frame));
  return new Set(cycles.flatMap(({ start_frame }, i) => (starts.has(start_frame) ? [i] : [])));
}

/** Return the index of the selected repetition, else of the one at the playhead; -1 if neither. */
function findCurrentCycle(store: Store, cycles: readonly CycleCurve[]): number {
  const { level, start_frame } = store.selected.value ?? {};
  const at = store.playhead.value;
  const selected = cycles.findIndex((each) => each.start_frame === start_frame);
  if (selected >= 0 && level === "primitive") return selected;
  return cycles.findIndex((each) => each.start_s <= at && at < each.stop_s);
}

/** Return a repetition's range of motion, maximum minus minimum; null if not recorded. */
function computeRange({ values }: CycleCurve): number | null {
  const known = values.filter((value) => value !== null);
  return known.length ? Math.max(...known) - Math.min(...known) : null;
}

/** Return mean and standard deviation of the ranges as text, such as "92 ± 3"; empty if none. */
export function summarizeRanges(cycles: readonly CycleCurve[]): string {
  const { mean, deviation } = computeMean(
    cycles.map(computeRange).filter((range) => range !== null),
  );
  if (mean === null) return "";
  return formatNumber(mean) + (deviation === null ? "" : ` ± ${formatNumber(deviation)}`);
}

/** Format a number with three significant digits. */
function formatNumber(value: number): string {
  return `${Number(value.toPrecision(3))}`;
}

function appendUnit(number: string, unit: string): string {
  return unit === "°" ? `${number}°` : `${number} ${unit}`.trim();
}

interface MeasuredCurves {
  data: RecordingData;
  channels: readonly CycleChannel[];
  /** null if the cluster has no curves. */
  curves: ClusterCurves | null;
  /** Curves of the other side of the body. */
  opposite: ClusterCurves | null;
}

/**
 * Return the loaded curves. The previous ones stay until the next arrive, unless the recording
 * changes. With `beside`, another recording takes the place of the other side of the body.
 */
function useClusterCurves(
  chosen: ReadonlySignal<string>,
  beside: ReadonlySignal<OpenRecording | undefined>,
): ReadonlySignal<MeasuredCurves | null> {
  const store = useStore();
  const measured = useSignal<MeasuredCurves | null>(null);
  // Changes when an edit is confirmed, not while it is sent.
  const revision = useComputed(() => store.recording.value?.revision ?? 0);
  const data = useComputed(() => store.active.value?.data);
  const cluster = useComputed(() => getShownCluster(store));
  const id = useComputed(() => beside.value?.recording.value.id ?? "");
  const revisionBeside = useComputed(() => beside.value?.recording.value.revision ?? 0);
  useSignalEffect(() => {
    let isCurrent = true;
    const [from, of, channel, now] = [data.value, cluster.value, chosen.value, revision.value];
    void revisionBeside.value;
    if (!from) return;
    void loadCurves(from, of, channel, now, id.value).then(
      (found) => {
        if (isCurrent) measured.value = found;
      },
      () => undefined, // the next change requests them again
    );
    return () => void (isCurrent = false);
  });
  return useComputed(() => (measured.value?.data === data.value ? measured.value : null));
}

/** Return the selected cluster's number, else the first; -1 without clusters. */
function getShownCluster(store: Store): number {
  return (store.shownCluster.value ?? store.clusters.value[0])?.id ?? -1;
}

async function loadCurves(
  data: RecordingData,
  cluster: number,
  chosen: string,
  revision: number,
  beside: string,
): Promise<MeasuredCurves> {
  if (cluster < 0) return { data, channels: [], curves: null, opposite: null };
  const channels = await data.loadCycleChannels();
  const channel = channels.some(({ name }) => name === chosen) ? chosen : "";
  const curves = await data.loadClusterCurves(cluster, channel, revision, beside);
  const other = !beside && channels.find(({ name }) => name === curves?.channel)?.opposite;
  const opposite = other ? await data.loadClusterCurves(cluster, other, revision) : null;
  return { data, channels, curves, opposite };
}
