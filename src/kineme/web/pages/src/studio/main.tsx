/** The studio: recordings of a folder, from the server that the page came from. */
import { effect } from "@preact/signals";
import { render } from "preact";
import "../styles/index.css";
import "./studio.css";
import { startKeys } from "../keys";
import { startPlayer } from "../player";
import { Store } from "../store";
import { Api } from "./server/api";
import { Editor } from "./editing/editor";
import { commandOf } from "./keys";
import { Session } from "./session";
import { exposeStudio } from "./snapshot";
import { Front, Studio } from "./Studio";
import { pageToken } from "./server/token";
import { announceTab } from "./editing/unsent";
import { Uploads } from "./server/uploads";

function start(): void {
  const store = new Store();
  const session = new Session(new Api(pageToken()), store);
  const editor = new Editor(session);
  const front = new Front();
  store.edits.value = {
    moveBorder: (level, frame, to) => editor.moveBorder(level, frame, to),
    nameCluster: (cluster, label) => editor.nameCluster(cluster, label),
  };
  addEventListener("keydown", (event) => onKey(event, editor, front));
  effect(() => {
    if (editor.naming.value) front.tab.value = "segment";
  });
  effect(() => {
    if (store.other.value) front.tab.value = "compare";
  });
  effect(() => {
    document.title = `${store.recording.value?.name ?? "kineme"} · kineme studio`;
  });
  startPlayer(store);
  exposeStudio(session);
  startKeys(store);
  render(
    <Studio session={session} editor={editor} uploads={new Uploads(session)} front={front} />,
    document.getElementById("page")!,
  );
  void session.start(announceTab());
}

function onKey(event: KeyboardEvent, editor: Editor, front: Front): void {
  const target = event.target instanceof Element ? event.target : null;
  const typing = target?.closest("input:not([type=range]), select, textarea, dialog");
  if (typing || event.defaultPrevented) return;
  const command = commandOf(event, editor, (dialog) => (front.dialog.value = dialog));
  if (!command) return;
  event.preventDefault();
  command();
}

start();
