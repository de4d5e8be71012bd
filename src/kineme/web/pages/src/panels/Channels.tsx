/** Show curves over time, below the timeline or in place of the 3-D view. */
import { signal, useComputed, useSignal, type ReadonlySignal } from "@preact/signals";
import { useEffect, useMemo } from "preact/hooks";
import { Canvas, useThrottled } from "../drawing";
import { Checkbox, TextInput } from "../layout/controls";
import type { Curve, CurveList, MotionHead } from "../messages";
import { useStore } from "../store";
import { readStored } from "../util";
import { CurveTiles, drawChannels, type Row } from "./channelDrawing";
import { Playhead, TimelineGestures } from "./Timeline";

const STORAGE_KEY = "kineme.curves";
const MAX_DEFAULT_CHANNELS = 8;
const DEFAULT_EFFECTORS = ["left_ankle", "right_ankle", "left_wrist", "right_wrist"];

/** Names of the chosen curves, for all recordings. */
const chosen = signal(loadChosen());

/** @param ruler whether to draw a time axis above the curves */
export function Channels({ ruler = false }: { ruler?: boolean }) {
  const store = useStore();
  const current = useCurveTiles();
  const gestures = useMemo(() => new TimelineGestures(store), [store]);
  const defaultJoints = useComputed(() => {
    const head = store.recording.value?.motion;
    return head ? getDefaultJoints(head) : [];
  });
  const shown = useComputed(() =>
    current.value ? selectCurves(current.value.list, defaultJoints.value) : [],
  );
  const [tiles, rows] = [current.value, shown.value];
  if (!tiles) return <div class="channels" aria-busy="true" />;
  const names = rows.map(({ head }) => `${head.name} ${head.group}`).join(", ");
  return (
    <div class="channels">
      {rows.length > 0 ? (
        <>
          <Canvas
            key={ruler ? "ruled" : "plain"}
            label={`Curves over time: ${names}. Click to go there; use the wheel to zoom, drag to pan.`}
            watch={() => {
              void [shown.value, tiles.loadCount.value, store.range.value, current.value];
              void [store.primitives.value, store.activities.value, store.labelColors.value];
            }}
            draw={(pen, width, height) => {
              const now = current.value;
              if (now) drawChannels(pen, shown.value, now, store, { width, height, ruler });
            }}
            gestures={gestures}
          />
          <Playhead />
        </>
      ) : (
        <p class="empty quiet">Choose what to draw: “Curves…”.</p>
      )}
      <CurrentValues rows={rows} tiles={tiles} ruler={ruler} />
      <ChannelChoice list={tiles.list} defaultJoints={defaultJoints.value} />
    </div>
  );
}

/** Return the names of the hand and foot joints, whose heights are shown by default. */
export function getDefaultJoints({ joints, effectors }: MotionHead): string[] {
  return DEFAULT_EFFECTORS.flatMap((part) => joints[effectors[part] ?? -1] ?? []);
}

/** Return the chosen curves; by default the first channels or the heights of the default joints. */
export function selectCurves(list: CurveList, defaultJoints: readonly string[]): Row[] {
  const all = list.curves.map((head, curve) => ({ curve, head }));
  const places = new Map(all.map((row) => [getCurveKey(row.head), row]));
  const found = chosen.value.flatMap((name) => places.get(name) ?? []);
  if (found.length) return found;
  const channels = all.filter(({ head }) => head.group === "channels");
  if (channels.length) return channels.slice(0, MAX_DEFAULT_CHANNELS);
  return defaultJoints.flatMap((name) => places.get(getCurveKey({ name, group: "height" })) ?? []);
}

/** Show a hidden curve or hide a shown one. */
export function toggleCurve(list: CurveList, defaultJoints: readonly string[], curve: Curve): void {
  const shown = selectCurves(list, defaultJoints).map(({ head }) => getCurveKey(head));
  const name = getCurveKey(curve);
  const names = new Set(list.curves.map(getCurveKey));
  // Curves of other kinds of recordings stay selected.
  const others = chosen.value.filter((each) => !names.has(each));
  const next = shown.includes(name) ? shown.filter((each) => each !== name) : [...shown, name];
  chosen.value = [...others, ...next];
  localStorage.setItem(STORAGE_KEY, JSON.stringify(chosen.value));
}

function getCurveKey({ name, group }: Pick<Curve, "name" | "group">): string {
  return `${group}: ${name}`;
}

function loadChosen(): string[] {
  const found = readStored(STORAGE_KEY);
  return Array.isArray(found) ? found.filter((each) => typeof each === "string") : [];
}

/** Return the curve tiles of the active recording; null while loading. */
function useCurveTiles(): ReadonlySignal<CurveTiles | null> {
  const store = useStore();
  const data = store.active.value?.data;
  const loaded = useSignal<CurveTiles | null>(null);
  useEffect(() => {
    let isCurrent = true;
    void data?.loadCurves().then(
      (list) => {
        if (isCurrent && list) loaded.value = new CurveTiles(data, list);
      },
      () => undefined,
    );
    return () => void (isCurrent = false);
  }, [data, loaded]);
  return useComputed(() => (loaded.value?.data === store.active.value?.data ? loaded.value : null));
}

/** Show each curve's value at the playhead. */
function CurrentValues(props: { rows: readonly Row[]; tiles: CurveTiles; ruler: boolean }) {
  const store = useStore();
  const { rows, tiles, ruler } = props;
  const frame = useThrottled(store.frame, store.playing);
  void tiles.loadCount.value;
  return (
    <div class={ruler ? "channel-values ruled" : "channel-values"} aria-hidden="true">
      {rows.map(({ curve, head }) => {
        const value = tiles.getValue(curve, frame.value);
        const text = value === null || Number.isNaN(value) ? "–" : formatShort(value);
        return (
          <span class="number" key={curve}>
            {text} <span class="quiet">{head.unit}</span>
          </span>
        );
      })}
    </div>
  );
}

function formatShort(value: number): string {
  const size = Math.abs(value);
  if (size >= 1e5 || (size > 0 && size < 1e-3)) return value.toExponential(1);
  return value.toFixed(size >= 100 ? 0 : size >= 10 ? 1 : 2);
}

/** List the curves to choose from, with a search field. */
function ChannelChoice(props: { list: CurveList; defaultJoints: readonly string[] }) {
  const { list, defaultJoints } = props;
  const search = useSignal("");
  const shown = new Set(selectCurves(list, defaultJoints).map(({ head }) => head));
  const words = search.value.toLowerCase().split(/\s+/);
  const found = list.curves.filter((head) =>
    words.every((word) => getCurveKey(head).toLowerCase().includes(word)),
  );
  const groups = [...new Set(found.map(({ group }) => group))];
  return (
    <details class="channel-choice">
      <summary>Curves…</summary>
      <div class="channel-list">
        <TextInput
          type="search"
          placeholder="Search: height foot"
          aria-label="Search the curves"
          value={search}
        />
        {groups.map((group) => (
          <fieldset key={group}>
            <legend class="quiet">{group}</legend>
            {found
              .filter((head) => head.group === group)
              .map((head) => (
                <Checkbox
                  key={head.name}
                  checked={shown.has(head)}
                  onCheck={() => toggleCurve(list, defaultJoints, head)}
                >
                  {head.name}
                </Checkbox>
              ))}
          </fieldset>
        ))}
        {!found.length && <p class="quiet">No curve has that name.</p>}
      </div>
    </details>
  );
}
