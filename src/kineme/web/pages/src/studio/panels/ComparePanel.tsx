/** How well the shown result agrees with the one it is compared with. */
import type { JSX } from "preact";
import { useStore } from "../../context";
import type { Comparison, Segment } from "../../messages";
import { laneOf, nameOf, segmentAt } from "../../segments";
import { clock } from "../../view";
import { useStudio } from "../context";
import { AgreementPanel } from "../people/AgreementPanel";
import { Button } from "../../layout/controls";

export function ComparePanel(): JSX.Element {
  const { session, front } = useStudio();
  const comparison = session.beside.comparison.value;
  const agreement = session.people.agreement.value;
  if (!comparison && agreement) return <AgreementPanel agreement={agreement} />;
  if (!comparison)
    return (
      <div class="compare-panel">
        <p class="quiet">
          Lay another preset’s result, or what one or more people say, below this one.
        </p>
        <p>
          <Button disabled={!session.edited.value} onClick={() => front.show("compare")}>
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
        <Button onClick={() => session.beside.stop()}>Stop comparing</Button>
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

/** Where the two say different things; a click goes there. */
function Differences({ comparison }: { comparison: Comparison }): JSX.Element {
  const store = useStore();
  const other = laneOf(comparison.segmentation, "activity");
  const present = store.activities.value;
  const nameAt = (lane: readonly Segment[], [start, stop]: readonly [number, number]): string => {
    const segment = segmentAt(lane, store.frameAt((start + stop) / 2));
    return segment ? nameOf(segment) : "";
  };
  return (
    <table class="differences number">
      <caption>Where they differ</caption>
      <thead>
        <tr>
          <th scope="col">From</th>
          <th scope="col">Seconds</th>
          <th scope="col">This table</th>
          <th scope="col">{comparison.name}</th>
        </tr>
      </thead>
      <tbody>
        {comparison.differences?.map((span) => (
          <tr key={span[0]}>
            <td>
              <Button class="link" onClick={() => store.seek(span[0])}>
                {clock(span[0], 2)}
              </Button>
            </td>
            <td>{(span[1] - span[0]).toFixed(2)}</td>
            <td>{nameAt(present, span)}</td>
            <td>{nameAt(other, span)}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}
