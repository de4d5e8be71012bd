/** Start the page that `kineme live --page` shows. */
import { signal } from "@preact/signals";
import { render } from "preact";
import "../../styles/theme.css";
import "../../styles/controls.css";
import "./live.css";
import type { LiveUpdate } from "../../messages";
import { readToken } from "../server/address";
import { Api } from "../server/api";
import { applyUpdate, type Live } from "./live";
import { LiveView } from "./LiveView";

const state = signal<Live | null>(null);
const connected = signal(true);

render(<LiveView state={state} connected={connected} />, document.getElementById("page")!);
new Api(readToken()).listen<LiveUpdate>(
  (update) => (state.value = applyUpdate(state.value, update)),
  (up) => (connected.value = up),
);
