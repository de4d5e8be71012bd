/** The page of a stream: what goes on, its count and tempo, and what was before. */
import type { ReadonlySignal } from "@preact/signals";
import type { JSX } from "preact";
import { Canvas } from "../../canvas/Canvas";
import { clusterColor } from "../../colors";
import { theme, toggleTheme } from "../../theme";
import { IconButton } from "../../transport/icons";
import { clock } from "../../view";
import { drawBody, drawChannels, drawTimeline } from "./drawing";
import { nameOf, statusOf, tempoOf, type Live } from "./live";

interface Props {
  state: ReadonlySignal<Live | null>;
  connected: ReadonlySignal<boolean>;
}

export function LiveView({ state, connected }: Props): JSX.Element {
  const live = state.value;
  const other = theme.value === "dark" ? "light" : "dark";
  const isBody = Boolean(live?.head.bones.length);
  const status = statusOf(live, connected.value);
  return (
    <main class="live">
      <header>
        <h1>kineme live</h1>
        <span class="number quiet">{clock(live?.now_s ?? 0)}</span>
        <span role="status" class={status === "Recording." ? "" : "stopped"}>
          {status}
        </span>
        {live?.notice && <span class="quiet">{live.notice}</span>}
        <span class="spacer" />
        <IconButton icon="theme" label={`Show the page ${other}`} onClick={toggleTheme} />
      </header>
      {live && (
        <>
          <Present live={live} />
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
          <Past live={live} />
        </>
      )}
    </main>
  );
}

function Present({ live: { current } }: { live: Live }): JSX.Element {
  const tempo = tempoOf(current?.stops ?? []);
  return (
    <section class="present" aria-label="What goes on">
      <p class="present-name">
        <Swatch cluster={current?.cluster ?? -1} /> {current?.name ?? "no activity"}
      </p>
      <p class="present-count number">{current?.count ?? "–"}</p>
      <p class="quiet number">{tempo === null ? "no tempo yet" : `${tempo.toFixed(0)} a minute`}</p>
    </section>
  );
}

function Past({ live: { past } }: { live: Live }): JSX.Element {
  return (
    <section class="past" aria-label="Activities that are over" tabIndex={0}>
      <table>
        <thead>
          <tr>
            <th>Activity</th>
            <th>From</th>
            <th>To</th>
            <th>Repetitions</th>
          </tr>
        </thead>
        <tbody class="number">
          {past.map((each) => (
            <tr key={each.start_s}>
              <td>
                <Swatch cluster={each.cluster} /> {nameOf(each)}
              </td>
              <td>{clock(each.start_s, 1)}</td>
              <td>{clock(each.stop_s, 1)}</td>
              <td>{each.repetitions}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </section>
  );
}

function Swatch({ cluster }: { cluster: number }): JSX.Element {
  return <span class="swatch" style={{ background: clusterColor(cluster) }} />;
}
