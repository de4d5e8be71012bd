/** Start the studio. */
import { computed, effect, untracked } from "@preact/signals";
import { render } from "preact";
import "../styles/index.css";
import "./studio.css";
import { Store, StoreProvider } from "../store";
import { createServices, StudioProvider } from "./context";
import { Api } from "./server/api";
import { getStudioCommand } from "./keys";
import { Session } from "./session";
import { Studio } from "./Studio";
import { readOpenIds, readToken } from "./server/address";
import { announceTab } from "./editing/editedRecording";
import { startPage } from "../page";

function start(): void {
  const store = new Store();
  const session = new Session(new Api(readToken()), store);
  const services = createServices(session);
  const { editor, review, view } = services;
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
  const getState = (): object => {
    const { segments } = store.table.value ?? { segments: [] };
    return {
      recordings: store.opened.value.map((opened) => opened.recording.value.name),
      segments,
      checked: segments.flatMap((row, i) => (row.checked ? [i] : [])),
      selected: store.selected.value ?? null,
      unsent: session.unsent.value,
    };
  };
  startPage(store, (event) => getStudioCommand(event, services), getState);
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
