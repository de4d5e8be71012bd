/** What every component of the studio has at hand. */
import { signal, type Signal } from "@preact/signals";
import { createContext } from "preact";
import { useContext } from "preact/hooks";
import type { Editor } from "./editing/editor";
import type { Poses } from "./poses/poses";
import type { Review } from "./review/review";
import type { Uploads } from "./server/uploads";
import type { Session } from "./session";

export type DialogName = "versions" | "transfer" | "compare" | "export" | "help" | "loops";

/** What of the page is in front. */
export class Front {
  readonly dialog: Signal<DialogName | null> = signal(null);
  readonly tab = signal("segment");
  /** Whether the page of the folder lies over that of a recording; null: where none is open. */
  readonly folder = signal<boolean | null>(null);

  show(dialog: DialogName): void {
    this.dialog.value = dialog;
  }
}

export interface StudioParts {
  session: Session;
  editor: Editor;
  review: Review;
  uploads: Uploads;
  poses: Poses;
  front: Front;
}

const StudioContext = createContext<StudioParts | null>(null);

export const StudioProvider = StudioContext.Provider;

export function useStudio(): StudioParts {
  const parts = useContext(StudioContext);
  if (!parts) throw new Error("A component stands outside of the StudioProvider.");
  return parts;
}
