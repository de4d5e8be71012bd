/** Show a modal dialog; Escape and a click outside close it. */
import type { ComponentChildren } from "preact";
import { useLayoutEffect, useRef } from "preact/hooks";
import { CloseButton } from "../../layout/controls";
import { Keys } from "../../about/About";
import { PAGE_KEYS } from "../../keys";
import { STUDIO_KEYS } from "../keys";

export interface DialogProps {
  close: () => void;
}

interface Props extends DialogProps {
  title: string;
  children: ComponentChildren;
}

export function Dialog({ title, close, children }: Props) {
  const dialog = useRef<HTMLDialogElement>(null);
  useLayoutEffect(() => dialog.current?.showModal(), []);
  return (
    <dialog
      ref={dialog}
      aria-label={title}
      onClose={close}
      onClick={(event) => event.target === dialog.current && close()}
    >
      <div class="dialog-body">
        <div class="panel-head">
          <h1>{title}</h1>
          <span class="spacer" />
          <CloseButton label="Close" onClick={close} />
        </div>
        {children}
      </div>
    </dialog>
  );
}

/** Show the keys and what the mouse does. */
export function HelpDialog({ close }: DialogProps) {
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
