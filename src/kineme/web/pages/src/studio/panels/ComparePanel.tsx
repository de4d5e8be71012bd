/** Show how well the result agrees with the compared one. */
import type { JSX } from "preact";
import { useStore } from "../../context";
import type { Comparison } from "../../messages";
import { getLane, getSegmentName, findSegmentAt } from "../../segments";
import { DifferenceTable } from "./DifferenceTable";
import { useStudio } from "../context";
import { AgreementPanel } from "../people/AgreementPanel";
import { Button } from "../../layout/controls";

export function ComparePanel(): JSX.Element {
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
    <div class="compare-panel">
      <div class="panel-head">
        <b class="name">{comparison.name}</b>
        <span class="spacer" />
        <Button onClick={() => session.comparisons.stop()}>Stop comparing</Button>
      </div>
      {(comparison.differences?.length ?? 0) > 0 && <Differences comparison={comparison} />}
      <table class="scores number">
        <tbody>
          {Object.entries(comparison.scores).map(([name, score]) => {
            const meaning = comparison.meanings?.[name];
            return (
              <tr key={name}>
                <th scope="row">
                  {meaning?.title ?? name.replaceAll("_", " ")}
                  {meaning && <small class="quiet">{meaning.help}</small>}
                </th>
                <td>{score.toFixed(3)}</td>
              </tr>
            );
          })}
        </tbody>
      </table>
      <p class="quiet">Scores and differences are of the table as it was when you compared.</p>
    </div>
  );
}

/** List where the two results differ; a click goes there. */
function Differences({ comparison }: { comparison: Comparison }): JSX.Element {
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
