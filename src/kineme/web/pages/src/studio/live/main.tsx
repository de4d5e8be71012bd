/** The page of a stream, which `kineme live --page` shows. */
import { signal } from "@preact/signals";
import { render } from "preact";
import "../../styles/theme.css";
import "../../styles/controls.css";
import "./live.css";
import type { LiveUpdate } from "../../messages";
import { tokenInAddress } from "../server/address";
import { Api } from "../server/api";
import { updated, type Live } from "./live";
import { LiveView } from "./LiveView";

const state = signal<Live | null>(null);
const connected = signal(true);

render(<LiveView state={state} connected={connected} />, document.getElementById("page")!);
new Api(tokenInAddress()).listen<LiveUpdate>(
  (update) => (state.value = updated(state.value, update)),
  (up) => (connected.value = up),
);
