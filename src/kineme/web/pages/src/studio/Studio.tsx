/** Render the studio: its header, notices, and the panels of every page and those that edit. */
import type { JSX } from "preact";
import { About, Keys, getAboutTitle } from "../panels/About";
import { Channels } from "../panels/Channels";
import { Clusters } from "../panels/Clusters";
import { useStore } from "../store";
import { Layout, Tabs } from "../layout/Layout";
import { MatrixPanel } from "../panels/Matrix";
import { PrintedReport } from "../panels/Repetitions";
import { Timeline } from "../panels/Timeline";
import { Transport } from "../panels/Transport";
import { Viewer } from "../viewer/Viewer";
import { useStudio, type DialogName, type DialogProps } from "./context";
import { CompareDialog, VersionsDialog } from "./dialogs/CompareDialog";
import { ComparePanel } from "./panels/ComparePanel";
import { DropZone, FolderPanel, OpeningProgress } from "./folder/FolderPanel";
import { ExportDialog } from "./dialogs/ExportDialog";
import { FolderPage } from "./folder/FolderPage";
import { QueueBar, ReviewPanel } from "./review/ReviewPanel";
import { PosesOffer } from "./panels/PosesOffer";
import { PresetPanel } from "./panels/PresetPanel";
import { ReadingPanel } from "./panels/ReadingPanel";
import { SegmentPanel } from "./panels/SegmentPanel";
import { SegmentTable } from "./table/SegmentTable";
import { TransferDialog } from "./dialogs/TransferDialog";
import type { Level } from "../messages";
import { createDeletion, createMerge } from "./editing/edits";
import { Button, CloseButton, Dialog, NumberInput, ThemeButton } from "../layout/controls";
import {
  untracked,
  useSignal,
  useSignalEffect,
  type ReadonlySignal,
  type Signal,
} from "@preact/signals";
import { RecordingVideo } from "../panels/Video";
import { buildPageAddress, readOpenIds } from "./server/address";
import { formatCount } from "../util";
import type { EditedRecording } from "./editing/editedRecording";
import { LoopsDialog } from "./dialogs/LoopsDialog";
import { PAGE_KEYS } from "../page";
import { STUDIO_KEYS } from "./keys";

/** Dialogs that list the folder. */
const LISTING = new Set(["compare", "export", "transfer"]);

export function Studio() {
  const store = useStore();
  const { session, view } = useStudio();
  const { value: dialog } = view.dialog;
  const close = (): void => {
    if (view.dialog.value === dialog) view.dialog.value = null; // another one may be open by now
  };
  const OpenDialog = dialog && DIALOGS[dialog];
  useSignalEffect(() => {
    // Files or names may have been added.
    if (LISTING.has(view.dialog.value ?? "")) untracked(() => void session.refresh());
  });
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
  const isReady = useStageReady();
  const isSignals = store.recording.value?.motion === null;
  return (
    <>
      {isSignals ? <Channels ruler /> : isReady.value && <Viewer />}
      <RecordingVideo>{(start) => <VideoOffset start={start} />}</RecordingVideo>
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

/** Edit the video's offset; it is known if the poses come from the video. */
function VideoOffset({ start }: { start: Signal<number> }) {
  const { session } = useStudio();
  const { value: recording } = session.store.recording;
  if (!recording || recording.video?.picture) return null;
  const place = (offset_s: number): void => {
    start.value = offset_s;
    void session.notifications.attempt("video", () =>
      session.api.placeVideo(recording.id, { offset_s }),
    );
  };
  return (
    <label title="Seconds of the video at the start of the recording">
      starts at <NumberInput step={0.02} value={+start.value.toFixed(3)} onNumber={place} /> s of
      the video
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

const DIALOG_BUTTONS: readonly (readonly [DialogName, text: string, title: string])[] = [
  ["versions", "History…", "Tables that were replaced: look at them, bring them back (H)"],
  ["transfer", "Labels…", "Labels from a knowledge base (T)"],
  ["compare", "Compare…", "Compare with another result (C)"],
  ["export", "Export…", "Write the segments as a file (E)"],
];

function Header() {
  const { session, view } = useStudio();
  const edited = session.edited.value;
  const recording = edited?.confirmed.value;
  const news = session.notifications.news.value;
  return (
    <>
      <h1>kineme</h1>
      {session.state.value?.of_library && <a href={buildPageAddress(session.api.token)}>Library</a>}
      <span class="folder quiet" title={session.state.value?.folder}>
        {recording?.name ?? session.state.value?.folder}
      </span>
      <div class="spacer news-place" role="status">
        {news && <span class={news.refused ? "news refused" : "news"}>{news.text}</span>}
      </div>
      <span class="group">
        <Button
          disabled={!recording?.can_undo && !session.unsent.value.length}
          title="Undo (Ctrl+Z)"
          onClick={() => edited?.undo()}
        >
          ↶ Undo
        </Button>
        <Button
          disabled={!recording?.can_redo}
          title="Redo (Ctrl+Shift+Z)"
          onClick={() => void edited?.edit({ kind: "redo" })}
        >
          ↷ Redo
        </Button>
      </span>
      <SaveState />
      <span class="group">
        {DIALOG_BUTTONS.map(([name, text, title]) => (
          <Button key={name} title={title} disabled={!recording} onClick={() => view.show(name)}>
            {text}
          </Button>
        ))}
      </span>
      <ThemeButton />
      <Button
        class="icon"
        title="Keys and help (?)"
        aria-label="Keys and help"
        onClick={() => view.show("help")}
      >
        ?
      </Button>
    </>
  );
}

/** Show whether segments are being computed, the file name, or the number of unsaved edits. */
function SaveState() {
  const { session } = useStudio();
  const { saved, finding } = session.edited.value?.confirmed.value ?? {};
  const waiting = session.unsent.value.length;
  const text = finding
    ? "finding the segments…"
    : waiting
      ? `saving ${formatCount(waiting, "edit")}…`
      : saved
        ? `saved as ${saved}`
        : "not corrected yet";
  return (
    <span class="save-state quiet" role="status" data-unsent={waiting} title={text}>
      {finding && <span class="busy" />} {session.edited.value ? text : ""}
    </span>
  );
}

export function Notices() {
  const { session } = useStudio();
  const { notifications, trouble, unsent } = session;
  return (
    <div class="notices">
      <div role="alert">
        {trouble.value && (
          <div class="notice danger" data-notice="trouble">
            <p>
              {trouble.value} {unsent.value.length > 0 && <UnsentEdits edits={unsent.value} />}
            </p>
          </div>
        )}
        {!trouble.value &&
          session.blocked.value.map((edited) => <BlockedEdits key={edited.id} edited={edited} />)}
        {notifications.problems.value.map(({ text }) => (
          <div class="notice danger" data-notice="problem" key={text}>
            <p>{text}</p>
            <CloseButton
              label="Dismiss"
              title="Dismiss (Escape)"
              onClick={() => notifications.dismiss(text)}
            />
          </div>
        ))}
      </div>
      <NameOfferNotice />
    </div>
  );
}

/** Ask whether to apply edits that were made on an older table. */
function BlockedEdits({ edited }: { edited: EditedRecording }) {
  return (
    <div class="notice" data-notice="held">
      <p>
        {edited.confirmed.value.name}: {edited.blocked.value}. It is shown as it is now.{" "}
        <UnsentEdits edits={edited.describeUnsent()} />
      </p>
      <Button class="primary" onClick={() => edited.retry()}>
        Make them here
      </Button>
      <Button onClick={() => edited.discardEdits()}>Drop them</Button>
    </div>
  );
}

function UnsentEdits({ edits }: { edits: string[] }) {
  const last = edits.slice(-3);
  const more = edits.length - last.length;
  return (
    <span class="waiting">
      Not saved yet: {more > 0 && `${more} earlier, `}
      {last.join("; ")}.
    </span>
  );
}

/** Offer to apply a cluster's new name to all recordings. */
function NameOfferNotice() {
  const { review } = useStudio();
  const { offer } = review;
  const { value: present } = offer.present;
  if (!present) return <div role="status" />;
  const { cluster, before, label } = present;
  return (
    <div class="notice" role="status">
      <p>
        Cluster {cluster} is “{label}” here.{" "}
        {offer.isLibrary()
          ? "The library knows it in other recordings, too."
          : `In other recordings it is known by its name, “${before}”.`}
      </p>
      <Button class="primary" onClick={() => void offer.accept()}>
        “{label}” in all recordings
      </Button>
      <CloseButton label="Here only" onClick={() => (offer.present.value = null)} />
    </div>
  );
}

/** Show the keys and what the mouse does. */
function HelpDialog({ close }: DialogProps) {
  return (
    <Dialog title="Keys" close={close}>
      <Keys keys={[...PAGE_KEYS, ...STUDIO_KEYS]} />
      <p class="quiet">
        Drag a border in the timeline to move it. Every edit is saved at once beside the recording,
        and can be undone.
      </p>
    </Dialog>
  );
}
