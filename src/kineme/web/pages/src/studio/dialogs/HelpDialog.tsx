/** Show the keys and what the mouse does. */
import type { JSX } from "preact";
import { Keys } from "../../about/Keys";
import { PAGE_KEYS } from "../../keys";
import { Dialog, type DialogProps } from "./Dialog";
import { STUDIO_KEYS } from "../keys";

export function HelpDialog({ close }: DialogProps): JSX.Element {
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
