/** Show the consequences of a previewed segmentation, and apply or discard it. */
import type { JSX } from "preact";
import { useStudio } from "../context";
import type { Proposal } from "../editing/comparisons";
import { formatCount } from "../../formatCount";
import { Button, Checkbox } from "../../layout/controls";

export function ProposalPanel(props: {
  proposal: Proposal;
  keep: boolean;
  setKeep: (keep: boolean) => void;
}): JSX.Element {
  const { session } = useStudio();
  const { proposal, keep, setKeep } = props;
  const { preview } = proposal;
  const counts = `${formatCount(preview.corrections, "correction")}, ${formatCount(preview.names, "name")}`;
  const some = preview.corrections + preview.names > 0;
  return (
    <div class="proposed" role="group" aria-label="Preview">
      <div class="proposed-said">
        {some && (
          <Checkbox checked={keep} onCheck={setKeep}>
            Take over {counts}
          </Checkbox>
        )}
        {some && keep && preview.lost.length > 0 && (
          <details open>
            <summary>{formatCount(preview.lost.length, "name")} would be lost</summary>
            <ul>
              {preview.lost.map((what) => (
                <li key={what}>{what}</li>
              ))}
            </ul>
          </details>
        )}
        <p class="quiet">
          Shown below what is there; borders that differ are marked. Nothing has been changed.
        </p>
      </div>
      <p class="actions">
        <Button onClick={() => session.comparisons.discard()}>Discard</Button>
        <Button
          class="primary"
          disabled={keep !== proposal.keep}
          onClick={() => session.comparisons.apply()}
        >
          {some ? (keep ? "Apply" : `Apply: replaces ${counts}`) : "Apply"}
        </Button>
      </p>
    </div>
  );
}
