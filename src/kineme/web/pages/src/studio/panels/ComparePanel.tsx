/** How well the shown result agrees with the one it is compared with. */
import type { JSX } from "preact";
import { useStudio } from "../context";

export function ComparePanel(): JSX.Element {
  const { session, front } = useStudio();
  const comparison = session.beside.comparison.value;
  if (!comparison)
    return (
      <div class="compare-panel">
        <p class="quiet">Lay another preset’s result, or an annotation, below this one.</p>
        <p>
          <button
            type="button"
            disabled={!session.edited.value}
            onClick={() => front.show("compare")}
          >
            Compare…
          </button>
        </p>
      </div>
    );
  return (
    <div class="compare-panel">
      <div class="panel-head">
        <b class="name">{comparison.name}</b>
        <span class="spacer" />
        <button type="button" onClick={() => session.beside.stop()}>
          Stop comparing
        </button>
      </div>
      <table class="scores number">
        <tbody>
          {Object.entries(comparison.scores).map(([name, score]) => (
            <tr key={name}>
              <th scope="row">{name.replaceAll("_", " ")}</th>
              <td>{score.toFixed(3)}</td>
            </tr>
          ))}
        </tbody>
      </table>
      <p class="quiet">Scores are of the table as it was when you compared.</p>
    </div>
  );
}
