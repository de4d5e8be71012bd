/** The page of a report. */
import type { JSX } from "preact";
import { useStore } from "../context";
import { About, aboutTitle } from "../about/About";
import { Keys } from "../about/Keys";
import { PAGE_KEYS } from "../keys";
import { Channels } from "../channels/Channels";
import { Clusters } from "../clusters/Clusters";
import { Film } from "../film/Film";
import { DetailSlider } from "../layout/DetailSlider";
import { Layout } from "../layout/Layout";
import { Tabs } from "../layout/Tabs";
import { MatrixPlace } from "../matrix/MatrixPlace";
import { theme, toggleTheme } from "../theme";
import { Timeline } from "../timeline/Timeline";
import { IconButton } from "../transport/icons";
import { Transport } from "../transport/Transport";
import { Viewer } from "../viewer/Viewer";
import { Paper, Repetitions } from "../paper/Repetitions";

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
    { id: "repetitions", title: "Repetitions", panel: () => <Repetitions of={store.recording} /> },
    { id: "keys", title: "Keys", panel: () => <Keys keys={PAGE_KEYS} /> },
    { id: "about", title: aboutTitle(store), panel: () => <About /> },
  ];
  return (
    <>
      <Layout
        header={<Header />}
        viewer={
          <>
            {store.recording.value?.motion ? <Viewer /> : <Channels ruler />}
            <Film />
          </>
        }
        matrix={<MatrixPlace />}
        side={<Tabs label="About the recording" tabs={tabs} />}
        transport={<Transport />}
        timeline={<Timeline />}
      />
      <Paper />
    </>
  );
}

function Header(): JSX.Element {
  const store = useStore();
  const other = theme.value === "dark" ? "light" : "dark";
  return (
    <>
      <h1>{store.recording.value?.name}</h1>
      <span class="quiet">kineme report</span>
      <span class="spacer" />
      <IconButton icon="theme" label={`Show the page ${other}`} onClick={toggleTheme} />
    </>
  );
}
