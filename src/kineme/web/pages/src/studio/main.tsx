/** Start the studio. */
import { effect } from "@preact/signals";
import { render } from "preact";
import "../styles/index.css";
import "./studio.css";
import "./folder/folder.css";
import { StoreProvider } from "../context";
import { startPrinting } from "../print/printing";
import { listenToKeys } from "../keys";
import { startPlayer } from "../player";
import { Store } from "../store";
import { StudioView, StudioProvider } from "./context";
import { Api } from "./server/api";
import { Editor } from "./editing/editor";
import { getStudioCommand } from "./keys";
import { rememberLevel } from "./rememberedLevel";
import { Poses } from "./poses/poses";
import { Review } from "./review/review";
import { Session } from "./session";
import { exposeStudio } from "./snapshot";
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
  exposeStudio(session);
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

start();
