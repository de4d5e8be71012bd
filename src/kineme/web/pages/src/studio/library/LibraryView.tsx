/** Render the page of a library: clusters, recordings and search by example. */
import { formatCount } from "../../formatCount";
import type { JSX } from "preact";
import { Tabs } from "../../layout/Tabs";
import { buildFolderAddress } from "../server/address";
import { ThemeButton } from "../../transport/icons";
import { ClusterCards } from "./ClusterCards";
import type { LibraryPage } from "./libraryPage";
import { Recordings } from "./Recordings";
import { Search } from "./Search";

export function LibraryView({ page }: { page: LibraryPage }): JSX.Element {
  const { value: state } = page.state;
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
