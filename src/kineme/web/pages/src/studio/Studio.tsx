/** The page of the studio: the parts of every page, and around them what changes a result. */
import type { JSX } from "preact";
import { About, aboutTitle } from "../about/About";
import { Channels } from "../channels/Channels";
import { Clusters } from "../clusters/Clusters";
import { useStore } from "../context";
import { Layout } from "../layout/Layout";
import { Tabs } from "../layout/Tabs";
import { MatrixPlace } from "../matrix/MatrixPlace";
import { Paper } from "../paper/Repetitions";
import { Timeline } from "../timeline/Timeline";
import { Transport } from "../transport/Transport";
import { Viewer } from "../viewer/Viewer";
import { type DialogName, useStudio } from "./context";
import { CompareDialog } from "./dialogs/CompareDialog";
import { ComparePanel } from "./panels/ComparePanel";
import { DropZone } from "./panels/DropZone";
import { EditTools } from "./panels/EditTools";
import { ExportDialog } from "./dialogs/ExportDialog";
import { FolderPage } from "./folder/FolderPage";
import { QueueBar } from "./folder/QueueBar";
import { useStageTurn } from "./folder/stageTurn";
import { FolderPanel } from "./panels/FolderPanel";
import { Header } from "./Header";
import { VersionsDialog } from "./dialogs/VersionsDialog";
import { LoopsDialog } from "./dialogs/LoopsDialog";
import { HelpDialog } from "./dialogs/HelpDialog";
import { Notices } from "./Notices";
import { Opening } from "./panels/Opening";
import { Video } from "./panels/Video";
import { PosesOffer } from "./poses/PosesOffer";
import { PresetPanel } from "./panels/PresetPanel";
import { ReadingPanel } from "./panels/ReadingPanel";
import { SegmentPanel } from "./panels/SegmentPanel";
import { ReviewPanel } from "./review/ReviewPanel";
import { SegmentTable } from "./table/SegmentTable";
import { TransferDialog } from "./dialogs/TransferDialog";

export function Studio(): JSX.Element {
  const store = useStore();
  const { front } = useStudio();
  const { value: dialog } = front.dialog;
  const close = (): void => {
    if (front.dialog.value === dialog) front.dialog.value = null; // not one opened since
  };
  const hasFigure = Boolean(store.recording.value?.motion);
  const tabs = [
    {
      id: "segment",
      title: "Segment",
      panel: () => <SegmentPanel />,
    },
    {
      id: "table",
      title: "Table",
      panel: () => <SegmentTable key={store.recording.value?.id} />,
    },
    {
      id: "review",
      title: "Review",
      panel: () => <ReviewPanel />,
    },
    { id: "clusters", title: "Clusters", panel: () => <Clusters /> },
    {
      id: "compare",
      title: "Compare",
      panel: () => <ComparePanel />,
    },
    { id: "about", title: aboutTitle(store), panel: () => <About /> },
  ];
  return (
    <>
      <Notices />
      <Layout
        header={<Header />}
        left={
          <>
            <FolderPanel />
            <PresetPanel />
            <ReadingPanel />
          </>
        }
        viewer={<Stage />}
        matrix={store.active.value && <MatrixPlace key={store.recording.value?.id} />}
        side={<Tabs label="About the recording" tabs={tabs} open={front.tab} />}
        transport={
          <>
            <Transport curves={hasFigure} />
            <EditTools />
          </>
        }
        timeline={store.active.value && <Timeline />}
        curves={hasFigure && store.curves.value && <Channels />}
      />
      <FolderPage />
      <Paper />
      <DropZone />
      <OpenDialog name={dialog} close={close} />
    </>
  );
}

/** The figures; their stage is set up at once, while the first recording is on its way. */
function Stage(): JSX.Element {
  const store = useStore();
  const { session } = useStudio();
  const turn = useStageTurn();
  if (store.recording.value?.motion === null)
    return (
      <>
        <Channels ruler />
        <Video />
        <QueueBar />
        <PosesOffer />
        <Opening />
      </>
    );
  return (
    <>
      {turn.value && <Viewer />}
      <Video />
      <QueueBar />
      <PosesOffer />
      {!store.active.value && !session.needing.value && (
        <p class="empty quiet">
          {session.opening.value || !session.state.value ? (
            <span class="busy" role="status" aria-label="Opening" />
          ) : (
            session.question.value || "Choose a recording on the left, or drop files here."
          )}
        </p>
      )}
      <Opening />
    </>
  );
}

interface DialogProps {
  name: DialogName | null;
  close: () => void;
}

function OpenDialog({ name, close }: DialogProps): JSX.Element | null {
  switch (name) {
    case "versions":
      return <VersionsDialog close={close} />;
    case "transfer":
      return <TransferDialog close={close} />;
    case "compare":
      return <CompareDialog close={close} />;
    case "export":
      return <ExportDialog close={close} />;
    case "loops":
      return <LoopsDialog close={close} />;
    case "help":
      return <HelpDialog close={close} />;
    case null:
      return null;
  }
}
