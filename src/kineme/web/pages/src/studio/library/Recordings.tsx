/** List the recordings of a library, with links to the studio. */
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { buildPageAddress } from "../server/address";
import { formatSeconds } from "./hits";
import type { LibraryPage } from "./libraryPage";
import { Button, TableHead, TextInput } from "../../layout/controls";

const PAGE_SIZE = 200;
/** Initial duration of a searched span, seconds. */
const DEFAULT_SPAN = 3;

export function Recordings({ page }: { page: LibraryPage }): JSX.Element {
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
        <table>
          <TableHead columns={["Recording", "Length", "Status", "Search"]} />
          <tbody>
            {found.slice(0, PAGE_SIZE).map((each) => (
              <tr key={each.recording}>
                <td>
                  {each.id ? (
                    <a href={buildPageAddress(page.api.token, each.id)}>{each.recording}</a>
                  ) : (
                    <span title="Its file is not where it was">{each.recording}</span>
                  )}
                </td>
                <td class="number">{formatSeconds(each.duration_s)}</td>
                <td>{each.status}</td>
                <td>
                  <Button
                    disabled={!each.vocabulary}
                    aria-label={`Find like a part of ${each.recording}`}
                    onClick={() => {
                      page.span.value = {
                        recording: each.recording,
                        start_s: 0,
                        stop_s: Math.min(DEFAULT_SPAN, each.duration_s),
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
      {found.length > PAGE_SIZE && (
        <p class="quiet">The first {PAGE_SIZE}; type a part of a name to see others.</p>
      )}
    </>
  );
}
