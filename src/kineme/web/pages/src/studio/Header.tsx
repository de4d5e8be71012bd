/** The bar on top: what is open, undo and redo, whether everything is saved, and the dialogs. */
import { counted } from "../counted";
import type { JSX } from "preact";
import { theme, toggleTheme } from "../theme";
import { IconButton } from "../transport/icons";
import { type DialogName, useStudio } from "./context";
import { pageAddress } from "./server/address";
import { Button } from "../layout/controls";

export function Header(): JSX.Element {
  const { session, front } = useStudio();
  const edited = session.edited.value;
  const recording = edited?.confirmed.value;
  const news = session.bulletin.news.value;
  const other = theme.value === "dark" ? "light" : "dark";
  return (
    <>
      <h1>kineme</h1>
      {session.state.value?.of_library && <a href={pageAddress(session.api.token)}>Library</a>}
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
        <Opener
          name="versions"
          title="Tables that were replaced: look at them, bring them back (H)"
          disabled={!recording}
        >
          History…
        </Opener>
        <Opener name="transfer" title="Labels from a knowledge base (T)" disabled={!recording}>
          Labels…
        </Opener>
        <Opener name="compare" title="Compare with another result (C)" disabled={!recording}>
          Compare…
        </Opener>
        <Opener name="export" title="Write the segments as a file (E)" disabled={!recording}>
          Export…
        </Opener>
      </span>
      <IconButton icon="theme" label={`Show the page ${other}`} onClick={toggleTheme} />
      <Button
        class="icon"
        title="Keys and help (?)"
        aria-label="Keys and help"
        onClick={() => front.show("help")}
      >
        ?
      </Button>
    </>
  );
}

function Opener(props: {
  name: DialogName;
  title: string;
  disabled: boolean;
  children: string;
}): JSX.Element {
  const { front } = useStudio();
  return (
    <Button title={props.title} disabled={props.disabled} onClick={() => front.show(props.name)}>
      {props.children}
    </Button>
  );
}

/** That segments are being found, "saved as …", or how many edits are not. */
function SaveState(): JSX.Element {
  const { session } = useStudio();
  const { saved, finding } = session.edited.value?.confirmed.value ?? {};
  const waiting = session.unsent.value.length;
  const text = finding
    ? "finding the segments…"
    : waiting
      ? `saving ${counted(waiting, "edit")}…`
      : saved
        ? `saved as ${saved}`
        : "not corrected yet";
  return (
    <span class="save-state quiet" role="status" data-unsent={waiting} title={text}>
      {finding && <span class="busy" />} {session.edited.value ? text : ""}
    </span>
  );
}
