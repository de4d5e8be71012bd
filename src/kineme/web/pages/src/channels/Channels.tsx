/** Curves and signals over time: under the timeline, or on the stage of a recording without a body. */
import { useMemo } from "preact/hooks";
import type { JSX } from "preact";
import { useStore } from "../context";
import { useCalm } from "../canvas/calm";
import { Canvas } from "../canvas/Canvas";
import { Line } from "../canvas/Line";
import type { Store } from "../store";
import { Gestures } from "../timeline/gestures";
import { GUTTER } from "../timeline/lanes";
import { toPixel } from "../view";
import { ChannelChoice } from "./ChannelChoice";
import { endsOf, rowsOf } from "./chosen";
import { boxOf, drawChannels, type Row } from "./drawing";
import type { CurveTiles } from "./tiles";
import { useTiles } from "./useTiles";

interface Props {
  /** Whether times are written above. */
  ruler?: boolean;
}

export function Channels({ ruler = false }: Props): JSX.Element | null {
  const store = useStore();
  const current = useTiles();
  const gestures = useMemo(
    () =>
      new Gestures(
        store,
        () => [],
        () => undefined,
      ),
    [store],
  );
  const tiles = current.value;
  if (!tiles) return <div class="channels" aria-busy="true" />;
  const ends = endsOfShown(store);
  const rows = rowsOf(tiles.list, ends);
  const names = rows.map(({ head }) => `${head.name} ${head.group}`).join(", ");
  return (
    <div class="channels">
      {rows.length > 0 ? (
        <Canvas
          key={ruler ? "ruled" : "plain"}
          label={`Curves over time: ${names}. Click to go there; use the wheel to zoom, drag to pan.`}
          watch={() =>
            void [
              rowsOf(tiles.list, endsOfShown(store)),
              tiles.arrived.value,
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
            const shown = rowsOf(now.list, endsOfShown(store));
            drawChannels(pen, shown, now, store, { width, height, ruler });
          }}
          gestures={gestures}
        />
      ) : (
        <p class="empty quiet">Choose what to draw: “Curves…”.</p>
      )}
      {rows.length > 0 && (
        <div class="playhead-room" style={{ left: `${GUTTER}px` }}>
          <Line share={toPixel(store.range.value, 1, store.playhead.value)} />
        </div>
      )}
      <Values rows={rows} tiles={tiles} ruler={ruler} />
      <ChannelChoice list={tiles.list} ends={ends} />
    </div>
  );
}

function endsOfShown(store: Store): string[] {
  const head = store.recording.value?.motion;
  return head ? endsOf(head) : [];
}

/** What each curve is at the playhead. */
function Values(props: { rows: readonly Row[]; tiles: CurveTiles; ruler: boolean }): JSX.Element {
  const store = useStore();
  const { rows, tiles, ruler } = props;
  const frame = useCalm(store.frame, store.playing);
  void tiles.arrived.value;
  return (
    <div class="channel-values number" aria-hidden="true">
      {rows.map(({ curve, head }, i) => {
        const value = tiles.at(curve, frame.value);
        const [top] = boxOf(i, rows.length, 100, false);
        const text = value === null || Number.isNaN(value) ? "–" : shortNumber(value);
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

function shortNumber(value: number): string {
  const size = Math.abs(value);
  if (size >= 1e5 || (size > 0 && size < 1e-3)) return value.toExponential(1);
  return value.toFixed(size >= 100 ? 0 : size >= 10 ? 1 : 2);
}
