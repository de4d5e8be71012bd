/** Render the studio: the parts of every page and those that edit a result. */
import type { JSX } from "preact";
import { About, getAboutTitle } from "../about/About";
import { Channels } from "../channels/Channels";
import { Clusters } from "../clusters/Clusters";
import { useStore } from "../context";
import { Layout } from "../layout/Layout";
import { Tabs } from "../layout/Tabs";
import { MatrixPanel } from "../matrix/MatrixPanel";
import { PrintedReport } from "../print/Repetitions";
import { Timeline } from "../timeline/Timeline";
import { Transport } from "../transport/Transport";
import { Viewer } from "../viewer/Viewer";
import { type DialogName, useStudio } from "./context";
import type { DialogProps } from "./dialogs/Dialog";
import { CompareDialog } from "./dialogs/CompareDialog";
import { ComparePanel } from "./panels/ComparePanel";
import { DropZone } from "./panels/DropZone";
import { EditTools } from "./panels/EditTools";
import { ExportDialog } from "./dialogs/ExportDialog";
import { FolderPage } from "./folder/FolderPage";
import { QueueBar } from "./folder/QueueBar";
import { useStageReady } from "./folder/useStageReady";
import { FolderPanel } from "./panels/FolderPanel";
import { Header } from "./Header";
import { VersionsDialog } from "./dialogs/VersionsDialog";
import { LoopsDialog } from "./dialogs/LoopsDialog";
import { HelpDialog } from "./dialogs/HelpDialog";
import { Notices } from "./Notices";
import { OpeningProgress } from "./panels/OpeningProgress";
import { StudioVideo } from "./panels/StudioVideo";
import { PosesOffer } from "./poses/PosesOffer";
import { PresetPanel } from "./panels/PresetPanel";
import { ReadingPanel } from "./panels/ReadingPanel";
import { SegmentPanel } from "./panels/SegmentPanel";
import { ReviewPanel } from "./review/ReviewPanel";
import { SegmentTable } from "./table/SegmentTable";
import { TransferDialog } from "./dialogs/TransferDialog";

export function Studio(): JSX.Element {
  const store = useStore();
  const { view } = useStudio();
  const { value: dialog } = view.dialog;
  const close = (): void => {
    if (view.dialog.value === dialog) view.dialog.value = null; // another one may be open by now
  };
  const OpenDialog = dialog && DIALOGS[dialog];
  const hasFigure = Boolean(store.recording.value?.motion);
  const tabs = [
    { id: "segment", title: "Segment", panel: () => <SegmentPanel /> },
    { id: "table", title: "Table", panel: () => <SegmentTable key={store.recording.value?.id} /> },
    { id: "review", title: "Review", panel: () => <ReviewPanel /> },
    { id: "clusters", title: "Clusters", panel: () => <Clusters /> },
    { id: "compare", title: "Compare", panel: () => <ComparePanel /> },
    { id: "about", title: getAboutTitle(store), panel: () => <About /> },
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
        matrix={store.active.value && <MatrixPanel key={store.recording.value?.id} />}
        side={<Tabs label="About the recording" tabs={tabs} open={view.tab} />}
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
      <PrintedReport />
      <DropZone />
      {OpenDialog && <OpenDialog close={close} />}
    </>
  );
}

/** Show the figures; the 3-D stage is set up while the first recording loads. */
function Stage(): JSX.Element {
  const store = useStore();
  const { session } = useStudio();
  const turn = useStageReady();
  if (store.recording.value?.motion === null)
    return (
      <>
        <Channels ruler />
        <StudioVideo />
        <QueueBar />
        <PosesOffer />
        <OpeningProgress />
      </>
    );
  return (
    <>
      {turn.value && <Viewer />}
      <StudioVideo />
      <QueueBar />
      <PosesOffer />
      {!store.active.value && !session.videoWithoutPoses.value && (
        <p class="empty quiet">
          {session.opening.value || !session.state.value ? (
            <span class="busy" role="status" aria-label="Opening" />
          ) : (
            session.question.value || "Choose a recording on the left, or drop files here."
          )}
        </p>
      )}
      <OpeningProgress />
    </>
  );
}

const DIALOGS: Record<DialogName, (props: DialogProps) => JSX.Element> = {
  versions: VersionsDialog,
  transfer: TransferDialog,
  compare: CompareDialog,
  export: ExportDialog,
  loops: LoopsDialog,
  help: HelpDialog,
};
