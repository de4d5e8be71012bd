/** The page of a library, which the studio's server shows where no recording is named. */
import { render } from "preact";
import "../../styles/index.css";
import "../studio.css";
import "./library.css";
import { watchFocus } from "../../focus";
import { tokenInAddress } from "../server/address";
import { shareToken } from "../server/token";
import { LibraryApi } from "./libraryApi";
import { LibraryPage } from "./libraryPage";
import { LibraryView } from "./LibraryView";

const api = new LibraryApi(tokenInAddress());
const page = new LibraryPage(api);
shareToken(api);
document.title = "Library · kineme studio";
render(<LibraryView page={page} />, document.getElementById("page")!);
addEventListener("focus", () => void page.refresh());
watchFocus();
void page.start();
