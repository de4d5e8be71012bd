/** The page of the studio: the parts of every page, and around them what changes a result. */
import { signal, type Signal } from "@preact/signals";
import type { JSX } from "preact";
import { About, aboutTitle } from "../about/About";
import { Channels } from "../channels/Channels";
import { Clusters } from "../clusters/Clusters";
import { Layout } from "../layout/Layout";
import { Tabs } from "../layout/Tabs";
import { MatrixPlace } from "../matrix/MatrixPlace";
import { Timeline } from "../timeline/Timeline";
import { Transport } from "../transport/Transport";
import { Viewer } from "../viewer/Viewer";
import { CompareDialog } from "./dialogs/CompareDialog";
import { ComparePanel } from "./panels/ComparePanel";
import { DropZone } from "./panels/DropZone";
import type { Editor } from "./editing/editor";
import { EditTools } from "./panels/EditTools";
import { ExportDialog } from "./dialogs/ExportDialog";
import { FolderPanel } from "./panels/FolderPanel";
import { type DialogName, Header } from "./Header";
import { VersionsDialog } from "./dialogs/VersionsDialog";
import { HelpDialog } from "./dialogs/HelpDialog";
import { Notices } from "./Notices";
import { Video } from "./panels/Video";
import { PresetPanel } from "./panels/PresetPanel";
import { ReadingPanel } from "./panels/ReadingPanel";
import { SegmentPanel } from "./panels/SegmentPanel";
import type { Review } from "./review/review";
import { ReviewPanel } from "./review/ReviewPanel";
import type { Session } from "./session";
import { SegmentTable } from "./table/SegmentTable";
import { TransferDialog } from "./dialogs/TransferDialog";
import type { Uploads } from "./server/uploads";

/** What of the page is in front. */
export class Front {
  readonly dialog: Signal<DialogName | null> = signal(null);
  readonly tab = signal("segment");
}

interface Props {
  session: Session;
  editor: Editor;
  review: Review;
  uploads: Uploads;
  front: Front;
}

export function Studio({ session, editor, review, uploads, front }: Props): JSX.Element {
  const { store } = session;
  const show = (dialog: DialogName): void => void (front.dialog.value = dialog);
  const { value: dialog } = front.dialog;
  const close = (): void => {
    if (front.dialog.value === dialog) front.dialog.value = null; // not one opened since
  };
  const hasFigure = Boolean(store.recording.value?.motion);
  const tabs = [
    {
      id: "segment",
      title: "Segment",
      panel: () => <SegmentPanel session={session} editor={editor} review={review} />,
    },
    {
      id: "table",
      title: "Table",
      panel: () => (
        <SegmentTable key={store.recording.value?.id} session={session} editor={editor} />
      ),
    },
    {
      id: "review",
      title: "Review",
      panel: () => <ReviewPanel session={session} review={review} />,
    },
    { id: "clusters", title: "Clusters", panel: () => <Clusters store={store} /> },
    {
      id: "compare",
      title: "Compare",
      panel: () => <ComparePanel session={session} choose={() => show("compare")} />,
    },
    { id: "about", title: aboutTitle(store), panel: () => <About store={store} /> },
  ];
  return (
    <>
      <Layout
        header={<Header session={session} show={show} />}
        left={
          <>
            <FolderPanel session={session} uploads={uploads} />
            <PresetPanel session={session} />
            <ReadingPanel session={session} />
          </>
        }
        viewer={<Stage session={session} />}
        matrix={store.active.value && <MatrixPlace key={store.recording.value?.id} store={store} />}
        side={<Tabs label="About the recording" tabs={tabs} open={front.tab} />}
        transport={
          <>
            <Transport store={store} curves={hasFigure} />
            <EditTools editor={editor} />
          </>
        }
        timeline={store.active.value && <Timeline store={store} />}
        curves={hasFigure && store.curves.value && <Channels store={store} />}
      />
      <Notices session={session} />
      <DropZone session={session} uploads={uploads} />
      <OpenDialog session={session} name={dialog} close={close} />
    </>
  );
}

/** The figures; their stage is set up at once, while the first recording is on its way. */
function Stage({ session }: { session: Session }): JSX.Element {
  const { store, opening } = session;
  if (store.recording.value?.motion === null) return <Channels store={store} ruler />;
  return (
    <>
      <Viewer store={store} />
      <Video session={session} />
      {!store.active.value && (
        <p class="empty quiet">
          {opening.value || !session.state.value ? (
            <span class="busy" role="status" aria-label="Opening" />
          ) : (
            "Choose a recording on the left, or drop files here."
          )}
        </p>
      )}
    </>
  );
}

function OpenDialog(props: {
  session: Session;
  name: DialogName | null;
  close: () => void;
}): JSX.Element | null {
  const { session, name, close } = props;
  switch (name) {
    case "versions":
      return <VersionsDialog session={session} close={close} />;
    case "transfer":
      return <TransferDialog session={session} close={close} />;
    case "compare":
      return <CompareDialog session={session} close={close} />;
    case "export":
      return <ExportDialog session={session} close={close} />;
    case "help":
      return <HelpDialog close={close} />;
    case null:
      return null;
  }
}
