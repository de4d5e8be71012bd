/** Show a modal dialog; Escape and a click outside close it. */
import type { ComponentChildren, JSX } from "preact";
import { useLayoutEffect, useRef } from "preact/hooks";
import { CloseButton } from "../../layout/controls";

export interface DialogProps {
  close: () => void;
}

interface Props extends DialogProps {
  title: string;
  children: ComponentChildren;
}

export function Dialog({ title, close, children }: Props): JSX.Element {
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
