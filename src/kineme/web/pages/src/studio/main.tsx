/** Start the studio. */
import { effect, computed, untracked } from "@preact/signals";
import { render } from "preact";
import "../styles/index.css";
import "./studio.css";
import "./folder/folder.css";
import { StoreProvider, Store } from "../store";
import { startPrinting } from "../print/Repetitions";
import { listenToKeys } from "../keys";
import { startPlayer } from "../player";
import { StudioView, StudioProvider } from "./context";
import { Api } from "./server/api";
import { Editor } from "./editing/editor";
import { getStudioCommand } from "./keys";
import { Poses } from "./poses/poses";
import { Review } from "./review/review";
import { Session } from "./session";
import { exposeSnapshot } from "../snapshot";
import { Studio } from "./Studio";
import { readOpenIds, readToken } from "./server/address";
import { announceTab } from "./editing/unsent";
import { Uploads } from "./server/uploads";

function start(): void {
  const store = new Store();
  const session = new Session(new Api(readToken()), store);
  const editor = new Editor(session);
  const view = new StudioView();
  const review = new Review(session, editor);
  const uploads = new Uploads(session);
  const services = { session, editor, review, uploads, poses: new Poses(session), view };
  store.edit.value = (edit) => editor.edit(edit);
  effect(() => {
    if (editor.naming.value) view.tab.value = "segment";
  });
  effect(() => {
    if (session.comparisons.comparison.value) view.tab.value = "compare";
  });
  effect(() => {
    document.title = `${store.recording.value?.name ?? "kineme"} · kineme studio`;
  });
  effect(() => {
    // A dialog would hide them.
    if (session.notifications.problems.value.length) view.dialog.value = null;
  });
  rememberLevel(store);
  startPlayer(store);
  exposeSnapshot(store, () => {
    const { segments } = store.table.value ?? { segments: [] };
    return {
      recordings: store.opened.value.map((opened) => opened.recording.value.name),
      segments,
      checked: segments.flatMap((row, i) => (row.checked ? [i] : [])),
      selected: store.selected.value ?? null,
      unsent: session.unsent.value,
    };
  });
  startPrinting();
  listenToKeys(store, (event) => getStudioCommand(event, services));
  for (const what of ["keyup", "blur"]) addEventListener(what, () => editor.release());
  render(
    <StoreProvider value={store}>
      <StudioProvider value={services}>
        <Studio />
      </StudioProvider>
    </StoreProvider>,
    document.getElementById("page")!,
  );
  if (!readOpenIds().length) void review.folder.refresh(); // in parallel with the list
  void session.start(announceTab());
}

/** Remember the edited level of each recording. */
function rememberLevel(store: Store): void {
  const key = computed(
    () => `kineme.level|${location.pathname}|${store.recording.value?.id ?? ""}`,
  );
  effect(() => {
    const level = localStorage.getItem(key.value) === "activity" ? "activity" : "primitive";
    untracked(() => (store.level.value = level));
  });
  effect(() => {
    const level = store.level.value;
    if (level === "activity") localStorage.setItem(key.peek(), level);
    else localStorage.removeItem(key.peek());
  });
}

start();
