/** Start the page of a library. */
import { render } from "preact";
import "../../styles/index.css";
import "../studio.css";
import "./library.css";
import { watchFocus } from "../../focus";
import { readToken } from "../server/address";
import { shareToken } from "../server/token";
import { LibraryApi } from "./libraryApi";
import { LibraryPage } from "./libraryPage";
import { LibraryView } from "./LibraryView";

const api = new LibraryApi(readToken());
const page = new LibraryPage(api);
shareToken(api);
document.title = "Library · kineme studio";
render(<LibraryView page={page} />, document.getElementById("page")!);
addEventListener("focus", () => void page.refresh());
watchFocus();
void page.start();
