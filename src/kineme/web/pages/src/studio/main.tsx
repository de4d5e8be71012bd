/** The studio: recordings of a folder, from the server that the page came from. */
import { effect } from "@preact/signals";
import { render } from "preact";
import "../styles/index.css";
import "./studio.css";
import "./folder/folder.css";
import { StoreProvider } from "../context";
import { startPrinting } from "../paper/printing";
import { startKeys } from "../keys";
import { startPlayer } from "../player";
import { Store } from "../store";
import { Front, StudioProvider } from "./context";
import { Api } from "./server/api";
import { Editor } from "./editing/editor";
import { commandOf } from "./keys";
import { rememberLevel } from "./rememberedLevel";
import { Poses } from "./poses/poses";
import { Review } from "./review/review";
import { Session } from "./session";
import { exposeStudio } from "./snapshot";
import { Studio } from "./Studio";
import { openInAddress, tokenInAddress } from "./server/address";
import { announceTab } from "./editing/unsent";
import { Uploads } from "./server/uploads";

function start(): void {
  const store = new Store();
  const session = new Session(new Api(tokenInAddress()), store);
  const editor = new Editor(session);
  const front = new Front();
  const review = new Review(session, editor);
  const uploads = new Uploads(session);
  const parts = { session, editor, review, uploads, poses: new Poses(session), front };
  store.edit.value = (edit) => editor.edit(edit);
  effect(() => {
    if (editor.naming.value) front.tab.value = "segment";
  });
  effect(() => {
    if (session.beside.comparison.value) front.tab.value = "compare";
  });
  effect(() => {
    document.title = `${store.recording.value?.name ?? "kineme"} · kineme studio`;
  });
  effect(() => {
    if (session.bulletin.problems.value.length) front.dialog.value = null; // it lies below
  });
  rememberLevel(store);
  startPlayer(store);
  exposeStudio(session);
  startPrinting();
  startKeys(store, (event) => commandOf(event, parts));
  for (const what of ["keyup", "blur"]) addEventListener(what, () => editor.release());
  render(
    <StoreProvider value={store}>
      <StudioProvider value={parts}>
        <Studio />
      </StudioProvider>
    </StoreProvider>,
    document.getElementById("page")!,
  );
  if (!openInAddress().length) void review.folder.refresh(); // beside the list, not after it
  void session.start(announceTab());
}

start();
