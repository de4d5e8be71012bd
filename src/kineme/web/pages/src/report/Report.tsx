/** The page of a report. */
import type { JSX } from "preact";
import { About, aboutTitle } from "../about/About";
import { Keys } from "../about/Keys";
import { PAGE_KEYS } from "../keys";
import { Channels } from "../channels/Channels";
import { Clusters } from "../clusters/Clusters";
import { DetailSlider } from "../layout/DetailSlider";
import { Layout } from "../layout/Layout";
import { Tabs } from "../layout/Tabs";
import { MatrixPlace } from "../matrix/MatrixPlace";
import type { Store } from "../store";
import { theme, toggleTheme } from "../theme";
import { Timeline } from "../timeline/Timeline";
import { IconButton } from "../transport/icons";
import { Transport } from "../transport/Transport";
import { Viewer } from "../viewer/Viewer";
import { Paper, Repetitions } from "./Repetitions";

export function Report({ store }: { store: Store }): JSX.Element {
  const tabs = [
    {
      id: "clusters",
      title: "Clusters",
      panel: () => (
        <>
          <DetailSlider store={store} />
          <Clusters store={store} />
        </>
      ),
    },
    { id: "repetitions", title: "Repetitions", panel: () => <Repetitions store={store} /> },
    { id: "keys", title: "Keys", panel: () => <Keys keys={PAGE_KEYS} /> },
    { id: "about", title: aboutTitle(store), panel: () => <About store={store} /> },
  ];
  return (
    <>
      <Layout
        header={<Header store={store} />}
        viewer={
          store.recording.value?.motion ? (
            <Viewer store={store} />
          ) : (
            <Channels store={store} ruler />
          )
        }
        matrix={<MatrixPlace store={store} />}
        side={<Tabs label="About the recording" tabs={tabs} />}
        transport={<Transport store={store} />}
        timeline={<Timeline store={store} />}
      />
      <Paper store={store} />
    </>
  );
}

function Header({ store }: { store: Store }): JSX.Element {
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
