/** List replaced tables of the recording, to compare or restore. */
import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { useStudio } from "../context";
import type { Version } from "../../messages";
import { formatCount } from "../../util";
import { describeEdit } from "../editing/describeEdit";
import { Dialog, type DialogProps } from "./Dialog";
import { Button } from "../../layout/controls";

export function VersionsDialog({ close }: DialogProps) {
  const { session } = useStudio();
  const versions = useSignal<Version[] | null>(null);
  const edited = session.edited.value;
  useEffect(() => {
    if (!edited) return;
    void session.notifications.attempt("versions", async () => {
      versions.value = (await session.api.loadVersions(edited.id)).versions;
    });
  }, [edited, session, versions]);
  const fps = edited?.confirmed.value.fps ?? 1;
  const look = (version: Version): Promise<boolean> =>
    session.notifications.attempt("versions", async () => {
      const found = await session.api.loadVersion(edited!.id, version.number);
      session.comparisons.showBelow({ ...found, name: `Version ${version.number}` }, true);
      close();
    });
  return (
    <Dialog title="Tables that were replaced" close={close}>
      <p class="quiet">
        Every table that another one took the place of is kept. Undo goes back edit by edit; here,
        whole tables come back, and what is shown now is kept in turn.
      </p>
      {versions.value?.length === 0 && <p>No table of this recording has been replaced yet.</p>}
      <table class="formats versions">
        <tbody>
          {versions.value?.map((version) => (
            <tr key={version.number}>
              <td class="quiet">{new Date(version.at).toLocaleString()}</td>
              <td>
                {version.edit ? `last: ${describeEdit(version.edit, fps)}` : "as it was found"}
                <br />
                <span class="quiet">
                  {formatCount(version.segments, "segment")}, {formatCount(version.names, "name")},{" "}
                  {formatCount(version.corrections, "correction")}
                </span>
              </td>
              <td>
                <span class="group">
                  <Button onClick={() => void look(version)}>Look</Button>
                  <Button
                    onClick={() => {
                      void edited?.edit({ kind: "restore", version: version.number });
                      close();
                    }}
                  >
                    Bring back
                  </Button>
                </span>
              </td>
            </tr>
          ))}
        </tbody>
      </table>
    </Dialog>
  );
}
