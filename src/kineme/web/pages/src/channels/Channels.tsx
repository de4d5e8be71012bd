/** Show curves over time, below the timeline or in place of the 3-D view. */
import { useMemo } from "preact/hooks";
import type { JSX } from "preact";
import { useStore } from "../context";
import { useThrottled } from "../canvas/useThrottled";
import { Canvas } from "../canvas/Canvas";
import { PlayheadLine } from "../canvas/PlayheadLine";
import type { Store } from "../store";
import { TimelineGestures } from "../timeline/gestures";
import { GUTTER_WIDTH } from "../timeline/lanes";
import { toPixel } from "../view";
import { ChannelChoice } from "./ChannelChoice";
import { getDefaultJoints, selectCurves } from "./curveSelection";
import { getRowBounds, drawChannels, type Row } from "./drawing";
import type { CurveTiles } from "./tiles";
import { useCurveTiles } from "./useCurveTiles";

interface Props {
  /** Whether to draw a time axis above the curves. */
  ruler?: boolean;
}

export function Channels({ ruler = false }: Props): JSX.Element | null {
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
function CurrentValues(props: {
  rows: readonly Row[];
  tiles: CurveTiles;
  ruler: boolean;
}): JSX.Element {
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
