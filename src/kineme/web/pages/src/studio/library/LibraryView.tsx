/** The page of a library: its clusters, its recordings, and a search by example. */
import { counted } from "../../counted";
import type { JSX } from "preact";
import { Tabs } from "../../layout/Tabs";
import { theme, toggleTheme } from "../../theme";
import { folderAddress } from "../server/address";
import { IconButton } from "../../transport/icons";
import { ClusterCards } from "./ClusterCards";
import type { LibraryPage } from "./libraryPage";
import { Recordings } from "./Recordings";
import { Search } from "./Search";

export function LibraryView({ page }: { page: LibraryPage }): JSX.Element {
  const { value: state } = page.state;
  const other = theme.value === "dark" ? "light" : "dark";
  const tabs = [
    { id: "clusters", title: "Clusters", panel: () => <ClusterCards page={page} /> },
    { id: "search", title: "Search", panel: () => <Search page={page} /> },
    { id: "recordings", title: "Recordings", panel: () => <Recordings page={page} /> },
  ];
  return (
    <main class="library">
      <header>
        <h1>kineme</h1>
        <span class="folder quiet" title={state?.folder}>
          {state?.folder.split(/[\\/]/).at(-1)}
        </span>
        <a href={folderAddress(page.api.token)}>All recordings</a>
        <span class="spacer" />
        {state && (
          <span class="quiet number sizes">
            {counted(state.recordings.length, "recording")}, {state.hours.toFixed(2)} h,{" "}
            {counted(state.clusters.length, "cluster")}
          </span>
        )}
        <IconButton icon="theme" label={`Show the page ${other}`} onClick={toggleTheme} />
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
