/** Start a report: one recording, stored in the page itself. */
import { batch } from "@preact/signals";
import { render } from "preact";
import "../styles/index.css";
import { StoreProvider } from "../context";
import { listenToKeys } from "../keys";
import { startPlayer } from "../player";
import { startPrinting } from "../print/printing";
import { exposeSnapshot } from "../snapshot";
import { EmbeddedData } from "../recordingData";
import { loadMotion, openRecording, type ShownRecording } from "../openRecording";
import { findDetailIndex, Store } from "../store";
import { Report } from "./Report";

async function start(): Promise<void> {
  const store = new Store();
  const opened = await openRecording(new EmbeddedData());
  store.add(opened);
  offerLevels(store, opened);
  document.title = `${opened.recording.value.name} · kineme report`;
  exposeSnapshot(store);
  startPlayer(store);
  listenToKeys(store);
  startPrinting();
  render(
    <StoreProvider value={store}>
      <Report />
    </StoreProvider>,
    document.getElementById("page")!,
  );
  await loadMotion(opened);
}

/** Let the user replace the table by those at other details. */
function offerLevels(store: Store, { recording }: ShownRecording): void {
  const { levels, segmentation } = recording.value;
  if (levels.length < 2) return;
  const given = segmentation.provenance.detail;
  const choose = (detail: number): void => {
    const chosen = levels[findDetailIndex(detail, all)]!;
    const { segments } = chosen;
    batch(() => {
      store.levels.value = { all, detail: chosen.detail, choose };
      const isShown = chosen.detail === shown;
      recording.value = {
        ...recording.value,
        // Selects the curves of this table.
        revision: isShown ? 0 : 1 + findDetailIndex(detail, all),
        segmentation: isShown ? segmentation : { ...segmentation, cluster_names: {}, segments },
      };
    });
  };
  const all = levels.map(({ detail }) => detail);
  const shown = typeof given === "number" ? given : 1;
  store.levels.value = { all, detail: shown, choose };
}

void start();
