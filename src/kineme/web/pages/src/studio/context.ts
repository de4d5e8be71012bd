/** Provide the studio's services to its components. */
import { signal, type Signal } from "@preact/signals";
import { createContext } from "preact";
import { useContext } from "preact/hooks";
import { Editor } from "./editing/editor";
import { Poses } from "./poses";
import { Review } from "./review/review";
import { Uploads } from "./folder/folder";
import type { Session } from "./session";

export type DialogName = "versions" | "transfer" | "compare" | "export" | "help" | "loops";

export interface DialogProps {
  close: () => void;
}

/** Which dialog, tab and page are shown. */
export class StudioView {
  readonly dialog: Signal<DialogName | null> = signal(null);
  readonly tab = signal("segment");
  /** Whether the folder page covers the recording; null: only if none is open. */
  readonly folder = signal<boolean | null>(null);

  show(dialog: DialogName): void {
    this.dialog.value = dialog;
  }
}

export interface StudioServices {
  session: Session;
  editor: Editor;
  review: Review;
  uploads: Uploads;
  poses: Poses;
  view: StudioView;
}

/** Create the services of a session and let the store edit with them. */
export function createServices(session: Session): StudioServices {
  const editor = new Editor(session);
  session.store.edit.value = (edit) => editor.edit(edit);
  const [uploads, poses] = [new Uploads(session), new Poses(session)];
  return {
    ...{ session, editor, uploads, poses },
    review: new Review(session, editor),
    view: new StudioView(),
  };
}

const StudioContext = createContext<StudioServices | null>(null);

export const StudioProvider = StudioContext.Provider;

export function useStudio(): StudioServices {
  const parts = useContext(StudioContext);
  if (!parts) throw new Error("A component stands outside of the StudioProvider.");
  return parts;
}
