/** Provide the studio's services to its components. */
import { signal, type Signal } from "@preact/signals";
import { createContext } from "preact";
import { useContext } from "preact/hooks";
import type { Editor } from "./editing/editor";
import type { Poses } from "./poses";
import type { Review } from "./review/review";
import type { Uploads } from "./folder/folder";
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

const StudioContext = createContext<StudioServices | null>(null);

export const StudioProvider = StudioContext.Provider;

export function useStudio(): StudioServices {
  const parts = useContext(StudioContext);
  if (!parts) throw new Error("A component stands outside of the StudioProvider.");
  return parts;
}
