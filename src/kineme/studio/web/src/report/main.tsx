/** The report: one recording out of the page itself. */
import { render } from "preact";
import "../styles/index.css";
import { EmbeddedSource } from "../source";
import { loadMotion, openRecording, Store } from "../store";
import { startPlayer } from "../player";
import { Report } from "./Report";

async function start(): Promise<void> {
  const store = new Store();
  const opened = await openRecording(new EmbeddedSource());
  store.add(opened);
  document.title = `${opened.recording.value.name} · kineme report`;
  startPlayer(store);
  render(<Report store={store} />, document.getElementById("page")!);
  await loadMotion(opened);
}

void start();
