/** Show how well the result agrees with the compared one. */
import type { ComponentChildren } from "preact";
import { useStore } from "../../store";
import type { Agreement, Comparison } from "../../messages";
import { findSegmentAt, getLane, getSegmentName } from "../../segments";
import { useStudio } from "../context";
import { Button } from "../../layout/controls";
import { formatTime } from "../../view";
import { TruncatedName } from "../folder/FolderPanel";
import { Table } from "../../layout/tables";

export function ComparePanel() {
  const { session, view } = useStudio();
  const comparison = session.comparisons.comparison.value;
  const agreement = session.people.agreement.value;
  if (!comparison && agreement) return <AgreementPanel agreement={agreement} />;
  if (!comparison)
    return (
      <div class="compare-panel">
        <p class="quiet">
          Lay another preset’s result, or what one or more people say, below this one.
        </p>
        <p>
          <Button disabled={!session.edited.value} onClick={() => view.show("compare")}>
            Compare…
          </Button>
        </p>
      </div>
    );
  return (
    <ComparedPanel title={comparison.name} stop={() => session.comparisons.stop()}>
      {Boolean(comparison.differences?.length) && <Differences comparison={comparison} />}
      <Table
        class="scores number"
        rows={Object.entries(comparison.scores).map(([name, score]) => {
          const meaning = comparison.meanings?.[name];
          const head = (
            <>
              {meaning?.title ?? name.replaceAll("_", " ")}
              {meaning && <small class="quiet">{meaning.help}</small>}
            </>
          );
          return { key: name, head, cells: [score.toFixed(3)] };
        })}
      />
      <p class="quiet">Scores and differences are of the table as it was when you compared.</p>
    </ComparedPanel>
  );
}

function ComparedPanel(props: { title: string; stop: () => void; children: ComponentChildren }) {
  return (
    <div class="compare-panel">
      <div class="panel-head">
        <b class="name">{props.title}</b>
        <span class="spacer" />
        <Button onClick={props.stop}>Stop comparing</Button>
      </div>
      {props.children}
    </div>
  );
}

/** List where the two results differ; a click goes there. */
function Differences({ comparison }: { comparison: Comparison }) {
  const store = useStore();
  const lanes = [store.activities.value, getLane(comparison.segmentation, "activity")];
  const differences = (comparison.differences ?? []).map(([start_s, stop_s]) => {
    const frame = store.getFrameAt((start_s + stop_s) / 2);
    const segments = lanes.map((lane) => findSegmentAt(lane, frame));
    return { start_s, stop_s, labels: segments.map((each) => (each ? getSegmentName(each) : "")) };
  });
  const names = ["This table", comparison.name];
  return <DifferenceTable caption="Where they differ" names={names} differences={differences} />;
}

/** List where the results with these names differ; a click goes there. */
function DifferenceTable(props: {
  caption: string;
  names: readonly string[];
  differences: readonly { start_s: number; stop_s: number; labels: readonly string[] }[];
}) {
  const { caption, names, differences } = props;
  const store = useStore();
  const rows = differences.map(({ start_s, stop_s, labels }) => ({
    key: start_s,
    cells: [
      <Button onClick={() => store.seek(start_s)}>{formatTime(start_s, 2)}</Button>,
      (stop_s - start_s).toFixed(2),
      ...labels.map((label) => label || "–"),
    ],
  }));
  return (
    <>
      <Table
        class="differences number"
        caption={caption}
        columns={["From", "Seconds", ...names]}
        rows={rows}
      />
      {rows.length === 0 && <p>Nowhere for more than 0.25 s.</p>}
    </>
  );
}

const BY_NAMES = "Names are compared, in capitals or small letters.";
const BY_MAPPING =
  "Names are missing or differ, so one person’s stand for another’s as they agree best.";

/** Show how well people agree: pairs, all together, by recording, and where they differ. */
function AgreementPanel({ agreement }: { agreement: Agreement }) {
  const { session } = useStudio();
  const here = session.people.recordingAgreement.value;
  return (
    <ComparedPanel
      title={`${agreement.annotators.length} people`}
      stop={() => session.people.stop()}
    >
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
    </ComparedPanel>
  );
}

function Pairs({ agreement }: { agreement: Agreement }) {
  const all = agreement.recordings.filter(
    (each) => each.annotators.length === agreement.annotators.length,
  );
  const rows = agreement.pairs.map(({ annotators, cohen_kappa, border_f1, recordings }) => ({
    key: annotators.join(),
    head: annotators.join(", "),
    cells: [formatScore(cohen_kappa), formatScore(border_f1), recordings],
  }));
  const together = {
    key: "all",
    head: (
      <>
        All <small class="quiet">Fleiss’ kappa</small>
      </>
    ),
    cells: [formatScore(agreement.fleiss_kappa), "", all.length],
  };
  return (
    <Table
      class="scores number"
      caption="Over the folder"
      columns={[
        "",
        ["Cohen’s kappa", "Frames that both say the same of, beyond what chance would give"],
        ["Border F1", "Borders of either that the other has within 0.25 s"],
        "Recordings",
      ]}
      rows={[...rows, together]}
    />
  );
}

/** List Fleiss' kappa of each recording; a click opens it. */
function ByRecording({ agreement }: { agreement: Agreement }) {
  const { session } = useStudio();
  return (
    <Table
      class="differences number"
      caption="By recording"
      columns={["Recording", "Fleiss’ kappa", "Differences"]}
      rows={agreement.recordings.map(({ id, name, fleiss_kappa, differences }) => ({
        key: id,
        cells: [
          <Button
            class="halves"
            title={name}
            aria-current={id === session.store.recording.value?.id}
            onClick={() => void session.open(id)}
          >
            <TruncatedName name={name} />
          </Button>,
          formatScore(fleiss_kappa),
          differences.length,
        ],
      }))}
    />
  );
}

function formatScore(score: number | null): string {
  return score === null ? "–" : score.toFixed(3);
}
