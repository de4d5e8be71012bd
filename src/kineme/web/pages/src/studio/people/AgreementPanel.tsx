/** Show how well people agree: pairs, all together, by recording, and where they differ. */
import type { JSX } from "preact";
import type { Agreement } from "../../messages";
import { DifferenceTable } from "../panels/DifferenceTable";
import { useStudio } from "../context";
import { TruncatedName } from "../panels/TruncatedName";
import { Button, TableHead } from "../../layout/controls";

const BY_NAMES = "Names are compared, in capitals or small letters.";
const BY_MAPPING =
  "Names are missing or differ, so one person’s stand for another’s as they agree best.";

export function AgreementPanel({ agreement }: { agreement: Agreement }): JSX.Element {
  const { session } = useStudio();
  const here = session.people.recordingAgreement.value;
  return (
    <div class="compare-panel">
      <div class="panel-head">
        <b class="name">{agreement.annotators.length} people</b>
        <span class="spacer" />
        <Button onClick={() => session.people.stop()}>Stop comparing</Button>
      </div>
      <p class="quiet">
        {agreement.by_names ? BY_NAMES : BY_MAPPING} 1 is equal; of kappa, 0 is what chance gives.
      </p>
      <Pairs agreement={agreement} />
      {here && (
        <DifferenceTable
          caption="Where they differ in this recording"
          names={here.annotators}
          differences={here.differences}
        />
      )}
      {agreement.recordings.length > 1 && <ByRecording agreement={agreement} />}
      {agreement.failures.map((failure) => (
        <p class="quiet" key={failure}>
          {failure}
        </p>
      ))}
      <p class="quiet">All this is of the labels as they were when you compared.</p>
    </div>
  );
}

function Pairs({ agreement }: { agreement: Agreement }): JSX.Element {
  const all = agreement.recordings.filter(
    (each) => each.annotators.length === agreement.annotators.length,
  );
  return (
    <table class="scores number">
      <caption>Over the folder</caption>
      <thead>
        <tr>
          <td />
          <td title="Frames that both say the same of, beyond what chance would give">
            Cohen’s kappa
          </td>
          <td title="Borders of either that the other has within 0.25 s">Border F1</td>
          <td>Recordings</td>
        </tr>
      </thead>
      <tbody>
        {agreement.pairs.map(({ annotators, cohen_kappa, border_f1, recordings }) => (
          <tr key={annotators.join()}>
            <th scope="row">{annotators.join(", ")}</th>
            <td>{formatScore(cohen_kappa)}</td>
            <td>{formatScore(border_f1)}</td>
            <td>{recordings}</td>
          </tr>
        ))}
        <tr>
          <th scope="row">
            All <small class="quiet">Fleiss’ kappa</small>
          </th>
          <td>{formatScore(agreement.fleiss_kappa)}</td>
          <td />
          <td>{all.length}</td>
        </tr>
      </tbody>
    </table>
  );
}

/** List Fleiss' kappa of each recording; a click opens it. */
function ByRecording({ agreement }: { agreement: Agreement }): JSX.Element {
  const { session } = useStudio();
  return (
    <table class="differences number">
      <caption>By recording</caption>
      <TableHead columns={["Recording", "Fleiss’ kappa", "Differences"]} />
      <tbody>
        {agreement.recordings.map(({ id, name, fleiss_kappa, differences }) => (
          <tr key={id}>
            <td>
              <Button
                class="link halves"
                title={name}
                aria-current={id === session.store.recording.value?.id}
                onClick={() => void session.open(id)}
              >
                <TruncatedName name={name} />
              </Button>
            </td>
            <td>{formatScore(fleiss_kappa)}</td>
            <td>{differences.length}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}

function formatScore(score: number | null): string {
  return score === null ? "–" : score.toFixed(3);
}
