/** Render the page of a report. */
import type { JSX } from "preact";
import { useStore } from "../context";
import { About, getAboutTitle } from "../about/About";
import { Keys } from "../about/Keys";
import { PAGE_KEYS } from "../keys";
import { Channels } from "../channels/Channels";
import { Clusters } from "../clusters/Clusters";
import { RecordingVideo } from "../video/RecordingVideo";
import { DetailSlider } from "../layout/DetailSlider";
import { Layout } from "../layout/Layout";
import { Tabs } from "../layout/Tabs";
import { MatrixPanel } from "../matrix/MatrixPanel";
import { Timeline } from "../timeline/Timeline";
import { ThemeButton } from "../transport/icons";
import { Transport } from "../transport/Transport";
import { Viewer } from "../viewer/Viewer";
import { PrintedReport, Repetitions } from "../print/Repetitions";

export function Report(): JSX.Element {
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

function Header(): JSX.Element {
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
