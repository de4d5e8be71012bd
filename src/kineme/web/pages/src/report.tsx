/** Start a report: one recording, stored in the page itself. */
import { batch, signal, type Signal } from "@preact/signals";
import { render } from "preact";
import type { Recording } from "./messages";
import "./styles/index.css";
import { Store, StoreProvider, findDetailIndex, useStore } from "./store";
import { PAGE_KEYS, startPage } from "./page";
import { PrintedReport, Repetitions } from "./panels/Repetitions";
import { EmbeddedData, loadMotion } from "./recordingData";
import { About, Keys, getAboutTitle } from "./panels/About";
import { Channels } from "./panels/Channels";
import { Clusters } from "./panels/Clusters";
import { RecordingVideo } from "./panels/Video";
import { DetailSlider, ThemeButton } from "./layout/controls";
import { Layout, Tabs } from "./layout/Layout";
import { MatrixPanel } from "./panels/Matrix";
import { Timeline } from "./panels/Timeline";
import { Transport } from "./panels/Transport";
import { Viewer } from "./viewer/Viewer";

async function start(): Promise<void> {
  const store = new Store();
  const data = new EmbeddedData();
  const recording = signal(data.readRecording());
  const opened = { data, recording, motion: signal(null), keypoints: signal(null) };
  store.add(opened);
  offerLevels(store, recording);
  document.title = `${recording.value.name} · kineme report`;
  startPage(store);
  render(
    <StoreProvider value={store}>
      <Report />
    </StoreProvider>,
    document.getElementById("page")!,
  );
  await loadMotion(opened);
}

/** Let the user replace the table by those at other details. */
function offerLevels(store: Store, recording: Signal<Recording>): void {
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

/** Render the page of a report. */
function Report() {
  const store = useStore();
  const tabs = [
    {
      id: "clusters",
      title: "Clusters",
      panel: () => (
        <>
          <DetailSlider />
          <Clusters />
        </>
      ),
    },
    {
      id: "repetitions",
      title: "Repetitions",
      panel: () => <Repetitions recording={store.recording} />,
    },
    { id: "keys", title: "Keys", panel: () => <Keys keys={PAGE_KEYS} /> },
    { id: "about", title: getAboutTitle(store), panel: () => <About /> },
  ];
  return (
    <>
      <Layout
        header={<Header />}
        viewer={
          <>
            {store.recording.value?.motion ? <Viewer /> : <Channels ruler />}
            <RecordingVideo />
          </>
        }
        matrix={<MatrixPanel />}
        side={<Tabs label="About the recording" tabs={tabs} />}
        transport={<Transport />}
        timeline={<Timeline />}
      />
      <PrintedReport />
    </>
  );
}

function Header() {
  const store = useStore();
  return (
    <>
      <h1>{store.recording.value?.name}</h1>
      <span class="quiet">kineme report</span>
      <span class="spacer" />
      <ThemeButton />
    </>
  );
}

void start();
