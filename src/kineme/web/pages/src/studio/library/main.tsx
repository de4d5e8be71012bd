/** Start the page of a library. */
import { render } from "preact";
import "../../styles/index.css";
import "../studio.css";
import "./library.css";
import { watchFocus } from "../../page";
import { buildFolderAddress, buildPageAddress, readToken } from "../server/address";
import { Api, shareToken } from "../server/api";
import { LibraryPage, formatSeconds } from "./libraryPage";
import { formatCount } from "../../util";
import { Tabs } from "../../layout/Layout";
import { Button, TextInput, ThemeButton } from "../../layout/controls";
import { ClusterCards } from "./ClusterCards";
import { Search } from "./Search";
import { useSignal } from "@preact/signals";
import { Table } from "../../layout/tables";

const PAGE_SIZE = 200;
/** Initial duration of a searched span, seconds. */
const DEFAULT_SPAN = 3;

const api = new Api(readToken());
const page = new LibraryPage(api);

/** Render the page of a library: clusters, recordings and search by example. */
function LibraryView() {
  const { value: state } = page.state;
  const tabs = [
    { id: "clusters", title: "Clusters", panel: () => <ClusterCards page={page} /> },
    { id: "search", title: "Search", panel: () => <Search page={page} /> },
    { id: "recordings", title: "Recordings", panel: () => <Recordings /> },
  ];
  return (
    <main class="library">
      <header>
        <h1>kineme</h1>
        <span class="folder quiet" title={state?.folder}>
          {state?.folder.split(/[\\/]/).at(-1)}
        </span>
        <a href={buildFolderAddress(page.api.token)}>All recordings</a>
        <span class="spacer" />
        {state && (
          <span class="quiet number sizes">
            {formatCount(state.recordings.length, "recording")}, {state.hours.toFixed(2)} h,{" "}
            {formatCount(state.clusters.length, "cluster")}
          </span>
        )}
        <ThemeButton />
      </header>
      {page.problem.value && (
        <p class="problem" role="alert">
          {page.problem.value}
        </p>
      )}
      {state ? (
        <Tabs label="The library" tabs={tabs} open={page.tab} />
      ) : (
        !page.problem.value && <span class="busy" role="status" aria-label="Opening" />
      )}
    </main>
  );
}

/** List the recordings of a library, with links to the studio. */
function Recordings() {
  const filter = useSignal("");
  const { recordings = [], failed = {} } = page.state.value ?? {};
  const text = filter.value.trim().toLowerCase();
  const found = recordings.filter((each) => each.recording.toLowerCase().includes(text));
  return (
    <>
      <div class="tools">
        <label>
          Filter <TextInput type="search" value={filter} />
        </label>
        <span class="quiet">
          {found.length} of {recordings.length}
        </span>
      </div>
      <div class="wide-table">
        <Table
          class="number"
          columns={["Recording", "Length", "Status", "Search"]}
          rows={[
            ...found.slice(0, PAGE_SIZE).map((each) => ({
              key: each.recording,
              cells: [
                each.id ? (
                  <a href={buildPageAddress(page.api.token, each.id)}>{each.recording}</a>
                ) : (
                  <span title="Its file is not where it was">{each.recording}</span>
                ),
                formatSeconds(each.duration_s),
                each.status,
                <Button
                  disabled={!each.vocabulary}
                  aria-label={`Find like a part of ${each.recording}`}
                  onClick={() => {
                    const stop_s = Math.min(DEFAULT_SPAN, each.duration_s);
                    page.span.value = { recording: each.recording, start_s: 0, stop_s };
                    page.tab.value = "search";
                  }}
                >
                  Find like…
                </Button>,
              ],
            })),
            ...Object.entries(failed).map(([path, reason]) => ({
              key: path,
              cells: [path, "", `not read: ${reason}`],
            })),
          ]}
        />
      </div>
      {found.length > PAGE_SIZE && (
        <p class="quiet">The first {PAGE_SIZE}; type a part of a name to see others.</p>
      )}
    </>
  );
}

shareToken(api);
document.title = "Library · kineme studio";
render(<LibraryView />, document.getElementById("page")!);
addEventListener("focus", () => {
  if (page.state.value && !page.problem.value) void page.load();
});
watchFocus();
void page.load();
