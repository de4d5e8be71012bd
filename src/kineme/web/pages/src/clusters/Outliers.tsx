/** Below the curves: the repetition one looks at, those farthest from the mean, those left out. */
import type { JSX } from "preact";
import { useStore } from "../context";
import type { ClusterCurves, CycleCurve } from "../messages";
import { formatNumber, rangeOf, selectCycle, withUnit } from "./cycles";
import { Button } from "../layout/controls";

const FARTHEST = 3; // repetitions named that differ most from the mean

interface Shown {
  curves: ClusterCurves;
  /** Numbers of the repetitions that people left out. */
  leftOut: ReadonlySet<number>;
}

/** The repetition at the playhead, how far it is from the mean, or why it is not in it. */
export function Chosen({ curves, leftOut, at }: Shown & { at: number }): JSX.Element {
  const store = useStore();
  const cycle = curves.cycles[at];
  if (!cycle) return <p class="chosen quiet">None of them at the playhead.</p>;
  const isOut = leftOut.has(at);
  const range = rangeOf(cycle);
  const key = store.selected.value?.start_frame === cycle.start_frame ? " (X)" : "";
  const edit = store.edit.value;
  return (
    <p class="chosen" aria-label="At the playhead">
      <span class="number">{cycle.start_s.toFixed(2)} s</span>
      {range !== null && (
        <span class="quiet">range {withUnit(formatNumber(range), curves.unit)}</span>
      )}
      <span class="quiet">{isOut ? "left out by hand" : deviationOf(cycle, curves.unit)}</span>
      <span class="spacer" />
      {edit && (
        <Button
          title={(isOut ? "Count it in the mean again" : "Leave it out of the mean") + key}
          onClick={() => edit({ kind: "exclude", frames: [cycle.start_frame], excluded: !isOut })}
        >
          {isOut ? "Bring back" : "Leave out"}
        </Button>
      )}
    </p>
  );
}

/** Each a way to it, and where edits are possible a way to leave it out. */
export function Farthest({ curves, leftOut }: Shown): JSX.Element | null {
  const { cycles, unit, n } = curves;
  if (n < 3) return null;
  const inMean = cycles.filter(({ counts }, i) => counts && !leftOut.has(i));
  return (
    <p class="farthest" aria-label="Farthest from the mean">
      <span class="quiet">Farthest:</span>
      {inMean.slice(0, FARTHEST).map((cycle) => (
        <Chip
          key={cycle.start_frame}
          cycle={cycle}
          deviation={deviationOf(cycle, unit)}
          excluded={true}
        />
      ))}
    </p>
  );
}

/** Each a way to it, and where edits are possible a way to bring it back. */
export function LeftOut({ curves, leftOut }: Shown): JSX.Element | null {
  if (!leftOut.size) return null;
  return (
    <p class="farthest left-out" aria-label="Left out by hand">
      <span class="quiet">Left out:</span>
      {curves.cycles.map(
        (cycle, i) =>
          leftOut.has(i) && (
            <Chip
              key={cycle.start_frame}
              cycle={cycle}
              deviation="left out by hand"
              excluded={false}
            />
          ),
      )}
    </p>
  );
}

interface ChipProps {
  cycle: CycleCurve;
  deviation: string;
  /** What a click on its sign makes of it. */
  excluded: boolean;
}

function Chip({ cycle, deviation, excluded }: ChipProps): JSX.Element {
  const store = useStore();
  const edit = store.edit.value;
  const at = `${cycle.start_s.toFixed(1)} s`;
  const what = excluded ? "Leave out of the mean" : "Bring back into the mean";
  return (
    <span class="chip">
      <Button
        title={`${deviation}, from ${cycle.start_s.toFixed(2)} to ${cycle.stop_s.toFixed(2)} s`}
        onClick={() => selectCycle(store, cycle)}
      >
        {at}
      </Button>
      {edit && (
        <Button
          title={what}
          aria-label={`${what}: ${at}`}
          onClick={({ detail }) => {
            if (detail < 2) edit({ kind: "exclude", frames: [cycle.start_frame], excluded }); // the next comes in its place
          }}
        >
          {excluded ? "×" : "↺"}
        </Button>
      )}
    </span>
  );
}

/** How far a repetition is from the mean, and why it is not in it. */
function deviationOf({ distance, note }: CycleCurve, unit: string): string {
  const number = distance?.toPrecision(2);
  const far = number === undefined ? "" : withUnit(number, unit);
  return [far && `${far} from the mean`, note].filter(Boolean).join(", ");
}
