/** The recordings of a library: how long, how far, opened in the studio. */
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { pageAddress } from "../server/address";
import { seconds } from "./hits";
import type { LibraryPage } from "./libraryPage";
import { Button } from "../../layout/controls";

const AT_ONCE = 200;
/** Seconds of a recording that a search begins with. */
const FIRST = 3;

export function Recordings({ page }: { page: LibraryPage }): JSX.Element {
  const filter = useSignal("");
  const { recordings = [], failed = {} } = page.state.value ?? {};
  const text = filter.value.trim().toLowerCase();
  const found = recordings.filter((each) => each.recording.toLowerCase().includes(text));
  return (
    <>
      <div class="tools">
        <label>
          Filter{" "}
          <input
            type="search"
            value={filter.value}
            onInput={(event) => (filter.value = event.currentTarget.value)}
          />
        </label>
        <span class="quiet">
          {found.length} of {recordings.length}
        </span>
      </div>
      <div class="wide-table">
        <table>
          <thead>
            <tr>
              <th scope="col">Recording</th>
              <th scope="col">Length</th>
              <th scope="col">Status</th>
              <th scope="col">Search</th>
            </tr>
          </thead>
          <tbody>
            {found.slice(0, AT_ONCE).map((each) => (
              <tr key={each.recording}>
                <td>
                  {each.id ? (
                    <a href={pageAddress(page.api.token, each.id)}>{each.recording}</a>
                  ) : (
                    <span title="Its file is not where it was">{each.recording}</span>
                  )}
                </td>
                <td class="number">{seconds(each.duration_s)}</td>
                <td>{each.status}</td>
                <td>
                  <Button
                    disabled={!each.vocabulary}
                    aria-label={`Find like a part of ${each.recording}`}
                    onClick={() => {
                      page.span.value = {
                        recording: each.recording,
                        start_s: 0,
                        stop_s: Math.min(FIRST, each.duration_s),
                      };
                      page.tab.value = "search";
                    }}
                  >
                    Find like…
                  </Button>
                </td>
              </tr>
            ))}
            {Object.entries(failed).map(([path, reason]) => (
              <tr key={path}>
                <td>{path}</td>
                <td />
                <td colSpan={2}>not read: {reason}</td>
              </tr>
            ))}
          </tbody>
        </table>
      </div>
      {found.length > AT_ONCE && (
        <p class="quiet">The first {AT_ONCE}; type a part of a name to see others.</p>
      )}
    </>
  );
}
