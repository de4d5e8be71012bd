/** The report: one recording out of the page itself. */
import { batch } from "@preact/signals";
import { render } from "preact";
import "../styles/index.css";
import { StoreProvider } from "../context";
import { startKeys } from "../keys";
import { startPlayer } from "../player";
import { startPrinting } from "../paper/printing";
import { exposeSnapshot } from "../snapshot";
import { EmbeddedData } from "../recordingData";
import { loadMotion, openRecording, type ShownRecording } from "../opened";
import { positionOf, Store } from "../store";
import { Report } from "./Report";

async function start(): Promise<void> {
  const store = new Store();
  const opened = await openRecording(new EmbeddedData());
  store.add(opened);
  offerLevels(store, opened);
  document.title = `${opened.recording.value.name} · kineme report`;
  exposeSnapshot(store);
  startPlayer(store);
  startKeys(store);
  startPrinting();
  render(
    <StoreProvider value={store}>
      <Report />
    </StoreProvider>,
    document.getElementById("page")!,
  );
  await loadMotion(opened);
}

/** The tables at other details are looked at in place of the first one. */
function offerLevels(store: Store, { recording }: ShownRecording): void {
  const { levels, segmentation } = recording.value;
  if (levels.length < 2) return;
  const given = segmentation.provenance.detail;
  const choose = (detail: number): void => {
    const chosen = levels[positionOf(detail, all)]!;
    const { segments } = chosen;
    batch(() => {
      store.levels.value = { all, detail: chosen.detail, choose };
      const isShown = chosen.detail === shown;
      recording.value = {
        ...recording.value,
        revision: isShown ? 0 : 1 + positionOf(detail, all), // of the curves of repetitions
        segmentation: isShown ? segmentation : { ...segmentation, cluster_names: {}, segments },
      };
    });
  };
  const all = levels.map(({ detail }) => detail);
  const shown = typeof given === "number" ? given : 1;
  store.levels.value = { all, detail: shown, choose };
}

void start();
