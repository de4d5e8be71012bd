/** Start the page that `kineme live --page` shows. */
import { signal } from "@preact/signals";
import { render } from "preact";
import "../../styles/base.css";
import "./live.css";
import type { LiveUpdate } from "../../messages";
import { readToken } from "../server/address";
import { Api } from "../server/api";
import { applyUpdate, computeTempo, describeStatus, getPartName, type Live } from "./live";
import { Canvas } from "../../drawing";
import { getClusterColor } from "../../colors";
import { Swatch, ThemeButton } from "../../layout/controls";
import { formatTime } from "../../view";
import { drawBody, drawChannels, drawTimeline } from "./drawing";
import { Table } from "../../layout/tables";

const state = signal<Live | null>(null);
const connected = signal(true);

/** Render the live page: current activity, count, tempo and history. */
function LiveView() {
  const live = state.value;
  const isBody = Boolean(live?.head.bones.length);
  const status = describeStatus(live, connected.value);
  return (
    <main class="live">
      <header>
        <h1>kineme live</h1>
        <span class="number quiet">{formatTime(live?.now_s ?? 0)}</span>
        <span role="status" class={status === "Recording." ? "" : "stopped"}>
          {status}
        </span>
        {live?.notice && <span class="quiet">{live.notice}</span>}
        <span class="spacer" />
        <ThemeButton />
      </header>
      {live && (
        <>
          <CurrentActivity live={live} />
          <Canvas
            class="live-source"
            label={isBody ? "The body as it was recorded last" : "Curves of the last 20 seconds"}
            watch={() => void state.value}
            draw={(pen, ...size) => (isBody ? drawBody : drawChannels)(pen, state.value!, ...size)}
          />
          <Canvas
            class="live-timeline"
            label="Activities and repetitions of the last two minutes; provisional ones are paler"
            watch={() => void state.value}
            draw={(pen, ...size) => drawTimeline(pen, state.value!, ...size)}
          />
          <PastActivities live={live} />
        </>
      )}
    </main>
  );
}

function CurrentActivity({ live: { current } }: { live: Live }) {
  const tempo = computeTempo(current?.stops ?? []);
  return (
    <section class="present" aria-label="What goes on">
      <p class="present-name">
        <Swatch color={getClusterColor(current?.cluster ?? -1)} /> {current?.name ?? "no activity"}
      </p>
      <p class="present-count number">{current?.count ?? "–"}</p>
      <p class="quiet number">{tempo === null ? "no tempo yet" : `${tempo.toFixed(0)} a minute`}</p>
    </section>
  );
}

function PastActivities({ live: { past } }: { live: Live }) {
  return (
    <section class="past" aria-label="Activities that are over" tabIndex={0}>
      <Table
        class="number"
        columns={["Activity", "From", "To", "Repetitions"]}
        rows={past.map((each) => ({
          key: each.start_s,
          cells: [
            <>
              <Swatch color={getClusterColor(each.cluster)} /> {getPartName(each)}
            </>,
            formatTime(each.start_s, 1),
            formatTime(each.stop_s, 1),
            each.repetitions,
          ],
        }))}
      />
    </section>
  );
}

render(<LiveView />, document.getElementById("page")!);
new Api(readToken()).listen<LiveUpdate>(
  (update) => (state.value = applyUpdate(state.value, update)),
  (up) => (connected.value = up),
);
