/** The page of the studio: the parts of every page, and around them what changes a result. */
import { signal, type Signal } from "@preact/signals";
import type { JSX } from "preact";
import { Layout } from "../layout/Layout";
import { Tabs } from "../layout/Tabs";
import { CompareDialog } from "./CompareDialog";
import { ComparePanel } from "./ComparePanel";
import { DropZone } from "./DropZone";
import type { Editor } from "./editor";
import { EditTools } from "./EditTools";
import { ExportDialog } from "./ExportDialog";
import { FolderPanel } from "./FolderPanel";
import { type DialogName, Header } from "./Header";
import { HelpDialog } from "./HelpDialog";
import { Notices } from "./Notices";
import { PresetPanel } from "./PresetPanel";
import { SegmentPanel } from "./SegmentPanel";
import type { Session } from "./session";
import { TransferDialog } from "./TransferDialog";
import type { Uploads } from "./uploads";

/** What of the page is in front. */
export class Front {
  readonly dialog: Signal<DialogName | null> = signal(null);
  readonly tab = signal("segment");
}

interface Props {
  session: Session;
  editor: Editor;
  uploads: Uploads;
  front: Front;
}

export function Studio({ session, editor, uploads, front }: Props): JSX.Element {
  const show = (dialog: DialogName): void => void (front.dialog.value = dialog);
  const { value: dialog } = front.dialog;
  const close = (): void => {
    if (front.dialog.value === dialog) front.dialog.value = null; // not one opened since
  };
  const tabs = [
    {
      id: "segment",
      title: "Segment",
      panel: () => <SegmentPanel session={session} editor={editor} />,
    },
    {
      id: "compare",
      title: "Compare",
      panel: () => <ComparePanel session={session} choose={() => show("compare")} />,
    },
  ];
  return (
    <>
      <Layout
        header={<Header session={session} show={show} />}
        left={
          <>
            <FolderPanel session={session} uploads={uploads} />
            <PresetPanel session={session} />
          </>
        }
        viewer={null}
        matrix={null}
        side={<Tabs label="About the recording" tabs={tabs} open={front.tab} />}
        transport={<EditTools editor={editor} />}
        timeline={null}
      />
      <Notices session={session} />
      <DropZone session={session} uploads={uploads} />
      <OpenDialog session={session} name={dialog} close={close} />
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
