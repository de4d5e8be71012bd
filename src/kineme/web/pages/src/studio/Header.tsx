/** Show the header: what is open, undo and redo, save state and dialogs. */
import { formatCount } from "../formatCount";
import type { JSX } from "preact";
import { ThemeButton } from "../transport/icons";
import { type DialogName, useStudio } from "./context";
import { buildPageAddress } from "./server/address";
import { Button } from "../layout/controls";

export function Header(): JSX.Element {
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
        <DialogButton
          name="versions"
          title="Tables that were replaced: look at them, bring them back (H)"
          disabled={!recording}
        >
          History…
        </DialogButton>
        <DialogButton
          name="transfer"
          title="Labels from a knowledge base (T)"
          disabled={!recording}
        >
          Labels…
        </DialogButton>
        <DialogButton name="compare" title="Compare with another result (C)" disabled={!recording}>
          Compare…
        </DialogButton>
        <DialogButton name="export" title="Write the segments as a file (E)" disabled={!recording}>
          Export…
        </DialogButton>
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

function DialogButton(props: {
  name: DialogName;
  title: string;
  disabled: boolean;
  children: string;
}): JSX.Element {
  const { view } = useStudio();
  return (
    <Button title={props.title} disabled={props.disabled} onClick={() => view.show(props.name)}>
      {props.children}
    </Button>
  );
}

/** Show whether segments are being computed, the file name, or the number of unsaved edits. */
function SaveState(): JSX.Element {
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
