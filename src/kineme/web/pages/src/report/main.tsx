/** The report: one recording out of the page itself. */
import { render } from "preact";
import "../styles/index.css";
import { startKeys } from "../keys";
import { startPlayer } from "../player";
import { startPrinting } from "./printing";
import { exposeSnapshot } from "../snapshot";
import { EmbeddedData } from "../recordingData";
import { loadMotion, openRecording } from "../opened";
import { Store } from "../store";
import { Report } from "./Report";

async function start(): Promise<void> {
  const store = new Store();
  const opened = await openRecording(new EmbeddedData());
  store.add(opened);
  document.title = `${opened.recording.value.name} · kineme report`;
  exposeSnapshot(store);
  startPlayer(store);
  startKeys(store);
  startPrinting();
  render(<Report store={store} />, document.getElementById("page")!);
  await loadMotion(opened);
}

void start();
