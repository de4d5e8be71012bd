/** Show curves over time, below the timeline or in place of the 3-D view. */
import { useMemo } from "preact/hooks";
import { useStore, type Store } from "../store";
import { useThrottled, Canvas, PlayheadLine } from "../canvas/Canvas";
import { TimelineGestures } from "../timeline/gestures";
import { GUTTER_WIDTH } from "../timeline/lanes";
import { toPixel } from "../view";
import { getDefaultJoints, selectCurves, getCurveKey, toggleCurve } from "./curveSelection";
import { getRowBounds, drawChannels, type Row } from "./drawing";
import { type CurveTiles, useCurveTiles } from "./tiles";
import { useSignal } from "@preact/signals";
import type { CurveList } from "../messages";
import { Checkbox, TextInput } from "../layout/controls";

/** @param ruler whether to draw a time axis above the curves */
export function Channels({ ruler = false }: { ruler?: boolean }) {
  const store = useStore();
  const current = useCurveTiles();
  const gestures = useMemo(
    () =>
      new TimelineGestures(
        store,
        () => [],
        () => undefined,
      ),
    [store],
  );
  const tiles = current.value;
  if (!tiles) return <div class="channels" aria-busy="true" />;
  const ends = getDefaultJointsOfStore(store);
  const rows = selectCurves(tiles.list, ends);
  const names = rows.map(({ head }) => `${head.name} ${head.group}`).join(", ");
  return (
    <div class="channels">
      {rows.length > 0 ? (
        <Canvas
          key={ruler ? "ruled" : "plain"}
          label={`Curves over time: ${names}. Click to go there; use the wheel to zoom, drag to pan.`}
          watch={() =>
            void [
              selectCurves(tiles.list, getDefaultJointsOfStore(store)),
              tiles.loadCount.value,
              store.range.value,
              store.primitives.value,
              store.activities.value,
              store.labelColors.value,
              current.value,
            ]
          }
          draw={(pen, width, height) => {
            const now = current.value;
            if (!now) return;
            const shown = selectCurves(now.list, getDefaultJointsOfStore(store));
            drawChannels(pen, shown, now, store, { width, height, ruler });
          }}
          gestures={gestures}
        />
      ) : (
        <p class="empty quiet">Choose what to draw: “Curves…”.</p>
      )}
      {rows.length > 0 && (
        <div class="playhead-room" style={{ left: `${GUTTER_WIDTH}px` }}>
          <PlayheadLine share={toPixel(store.range.value, 1, store.playhead.value)} />
        </div>
      )}
      <CurrentValues rows={rows} tiles={tiles} ruler={ruler} />
      <ChannelChoice list={tiles.list} defaultJoints={ends} />
    </div>
  );
}

function getDefaultJointsOfStore(store: Store): string[] {
  const head = store.recording.value?.motion;
  return head ? getDefaultJoints(head) : [];
}

/** Show each curve's value at the playhead. */
function CurrentValues(props: { rows: readonly Row[]; tiles: CurveTiles; ruler: boolean }) {
  const store = useStore();
  const { rows, tiles, ruler } = props;
  const frame = useThrottled(store.frame, store.playing);
  void tiles.loadCount.value;
  return (
    <div class="channel-values number" aria-hidden="true">
      {rows.map(({ curve, head }, i) => {
        const value = tiles.getValue(curve, frame.value);
        const [top] = getRowBounds(i, rows.length, 100, false);
        const text = value === null || Number.isNaN(value) ? "–" : formatShort(value);
        return (
          <span
            key={curve}
            style={{ top: ruler ? `calc(22px + (100% - 22px) * ${i / rows.length})` : `${top}%` }}
          >
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

interface ChannelChoiceProps {
  list: CurveList;
  /** Joints whose heights are shown by default. */
  defaultJoints: readonly string[];
}

/** List the curves to choose from, with a search field. */
function ChannelChoice({ list, defaultJoints }: ChannelChoiceProps) {
  const search = useSignal("");
  const shown = new Set(selectCurves(list, defaultJoints).map(({ curve }) => curve));
  const words = search.value.toLowerCase().split(/\s+/);
  const found = list.curves
    .map((head, curve) => ({ head, curve }))
    .filter(({ head }) => words.every((word) => getCurveKey(head).toLowerCase().includes(word)));
  const groups = [...new Set(found.map(({ head }) => head.group))];
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
              .filter(({ head }) => head.group === group)
              .map(({ head, curve }) => (
                <Checkbox
                  key={curve}
                  checked={shown.has(curve)}
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
