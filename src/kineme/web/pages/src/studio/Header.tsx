/** Show the header: what is open, undo and redo, save state and dialogs. */
import { formatCount } from "../util";
import { ThemeButton, Button } from "../layout/controls";
import { type DialogName, useStudio } from "./context";
import { buildPageAddress } from "./server/address";

const DIALOGS: readonly (readonly [DialogName, text: string, title: string])[] = [
  ["versions", "History…", "Tables that were replaced: look at them, bring them back (H)"],
  ["transfer", "Labels…", "Labels from a knowledge base (T)"],
  ["compare", "Compare…", "Compare with another result (C)"],
  ["export", "Export…", "Write the segments as a file (E)"],
];

export function Header() {
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
        {DIALOGS.map(([name, text, title]) => (
          <Button key={name} title={title} disabled={!recording} onClick={() => view.show(name)}>
            {text}
          </Button>
        ))}
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

/** Show whether segments are being computed, the file name, or the number of unsaved edits. */
function SaveState() {
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
