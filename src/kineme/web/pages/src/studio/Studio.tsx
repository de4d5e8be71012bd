/** Render the studio: the parts of every page and those that edit a result. */
import type { JSX } from "preact";
import { About, getAboutTitle } from "../about/About";
import { Channels } from "../channels/Channels";
import { Clusters } from "../clusters/Clusters";
import { useStore } from "../store";
import { Layout } from "../layout/Layout";
import { Tabs } from "../layout/Tabs";
import { MatrixPanel } from "../matrix/Matrix";
import { PrintedReport } from "../print/Repetitions";
import { Timeline } from "../timeline/Timeline";
import { Transport } from "../transport/Transport";
import { Viewer } from "../viewer/Viewer";
import { type DialogName, useStudio } from "./context";
import { type DialogProps, HelpDialog } from "./dialogs/Dialog";
import { CompareDialog, VersionsDialog } from "./dialogs/CompareDialog";
import { ComparePanel } from "./panels/ComparePanel";
import { DropZone, FolderPanel, OpeningProgress } from "./panels/FolderPanel";
import { ExportDialog, LoopsDialog } from "./dialogs/ExportDialog";
import { FolderPage } from "./folder/FolderPage";
import { QueueBar, ReviewPanel } from "./review/ReviewPanel";
import { Header } from "./Header";
import { Notices } from "./Notices";
import { PosesOffer } from "./poses/PosesOffer";
import { PresetPanel } from "./panels/PresetPanel";
import { ReadingPanel } from "./panels/ReadingPanel";
import { SegmentPanel } from "./panels/SegmentPanel";
import { SegmentTable } from "./table/SegmentTable";
import { TransferDialog } from "./dialogs/TransferDialog";
import type { Level } from "../messages";
import { createDeletion, createMerge } from "./editing/commands";
import { Button } from "../layout/controls";
import { type Signal, useSignal, useSignalEffect, type ReadonlySignal } from "@preact/signals";
import { RecordingVideo } from "../video/RecordingVideo";
import { readOpenIds } from "./server/address";

export function Studio() {
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
function Stage() {
  const store = useStore();
  const { session } = useStudio();
  const turn = useStageReady();
  const isSignals = store.recording.value?.motion === null;
  return (
    <>
      {isSignals ? <Channels ruler /> : turn.value && <Viewer />}
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

const LEVELS: readonly (readonly [Level, string])[] = [
  ["activity", "Activities"],
  ["primitive", "Primitives"],
];

/** Offer buttons to split, merge and delete. */
function EditTools() {
  const store = useStore();
  const { editor } = useStudio();
  const where = { lane: store.getLane(store.workLevel.value), frame: store.frame.value };
  const merge = "The segment and the next one become one (M)";
  const remove = "Delete the border nearest to the playhead (Delete)";
  const tools = [
    ["Split", "A border at the playhead (S)", editor.segment.value, () => editor.split()],
    ["Merge", merge, createMerge(where), () => editor.mergeWithNext()],
    ["Delete border", remove, createDeletion(where), () => editor.deleteBorder()],
  ] as const;
  return (
    <>
      <span class="group" role="group" aria-label="Work on">
        {LEVELS.map(([level, name]) => (
          <Button
            key={level}
            aria-pressed={store.workLevel.value === level}
            disabled={!store.getLane(level).length}
            title={`Work on ${name.toLowerCase()} (A)`}
            onClick={() => store.setLevel(level)}
          >
            {name}
          </Button>
        ))}
      </span>
      <span class="group edit-tools" role="group" aria-label="Segments">
        {tools.map(([text, title, enabled, act]) => (
          <Button key={text} disabled={!enabled} title={title} onClick={act}>
            {text}
          </Button>
        ))}
      </span>
    </>
  );
}

/** Show the recording's video, with a field for its offset. */
function StudioVideo() {
  return <RecordingVideo>{(start) => <VideoOffset start={start} />}</RecordingVideo>;
}

function VideoOffset({ start }: { start: Signal<number> }) {
  const { session } = useStudio();
  const { store, api } = session;
  // The poses come from it, so the offset is known.
  if (store.recording.value?.video?.picture) return null;
  const place = (seconds: number): void => {
    const { value: recording } = store.recording;
    if (!recording || !Number.isFinite(seconds)) return;
    start.value = seconds;
    const request = { offset_s: seconds };
    void session.notifications.attempt("video", () => api.placeVideo(recording.id, request));
  };
  return (
    <label title="Seconds of the video at the start of the recording">
      starts at{" "}
      <input
        type="number"
        class="number"
        step="0.02"
        defaultValue={String(+start.peek().toFixed(3))}
        onChange={(event) => place(event.currentTarget.valueAsNumber)}
      />{" "}
      s of the video
    </label>
  );
}

const DRAW_DELAY = 300; // milliseconds for drawing the folder's rows first

/**
 * Return whether to set up the 3-D stage, which blocks a page for half a second: at once if a
 * recording opens, else after the folder page.
 */
function useStageReady(): ReadonlySignal<boolean> {
  const { session, review } = useStudio();
  const isReady = useSignal(readOpenIds().length > 0);
  useSignalEffect(() => {
    if (isReady.value) return;
    const opens = session.opening.value !== null || session.store.opened.value.length > 0;
    if (opens) isReady.value = true;
    else if (review.folder.isReady.value) setTimeout(() => (isReady.value = true), DRAW_DELAY);
  });
  return isReady;
}
